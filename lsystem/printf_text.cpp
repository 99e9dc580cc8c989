#include "lsystem/printf_text.h"

#include <algorithm>
#include <cstdio>

namespace cambium {
namespace {

char escaped(char c) { return c == 'n' ? '\n' : c == 't' ? '\t' : c == 'r' ? '\r' : c; }

// `spec` is flags, width and precision behind a `%`.
std::string converted(const std::string& spec, char conversion, double value) {
  char text[128];
  constexpr std::string_view kWhole = "diuxXoc";
  if (kWhole.find(conversion) != std::string_view::npos) {
    const auto whole = static_cast<long long>(std::clamp(value, -9e18, 9e18));
    if (conversion == 'c') return std::string(1, static_cast<char>(whole));
    std::snprintf(text, sizeof text, ("%" + spec + "ll" + conversion).c_str(), whole);
  } else {
    std::snprintf(text, sizeof text, ("%" + spec + conversion).c_str(), value);
  }
  return text;
}

}  // namespace

std::string printf_text(std::string_view format, const double* values, std::size_t count) {
  constexpr std::string_view kSpec = "0123456789.-+ #";
  std::string out;
  std::size_t used = 0;
  for (std::size_t i = 0; i < format.size(); ++i) {
    if (format[i] == '\\' && i + 1 < format.size()) {
      out += escaped(format[++i]);
      continue;
    }
    if (format[i] != '%') {
      out += format[i];
      continue;
    }
    std::size_t end = i + 1;
    while (end < format.size() && kSpec.find(format[end]) != std::string_view::npos) ++end;
    const std::string spec(format.substr(i + 1, std::min<std::size_t>(end - i - 1, 8)));
    while (end < format.size() && (format[end] == 'l' || format[end] == 'h')) ++end;
    const char conversion = end < format.size() ? format[end] : '\0';
    if (conversion == '%') {
      out += '%';
    } else if (conversion != '\0' && std::string_view("diuxXocfFeEgG").find(conversion) != std::string_view::npos) {
      out += converted(spec, conversion, used < count ? values[used] : 0.0);
      ++used;
    } else {
      out += format.substr(i, end + 1 - i);
    }
    i = std::min(end, format.size());
  }
  return out;
}

}  // namespace cambium
