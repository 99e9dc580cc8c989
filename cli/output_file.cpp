#include "cli/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <mutex>
#include <set>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "blobtree/input_error.h"

namespace cambium {
namespace {

namespace fs = std::filesystem;

/// Temporary files that exist now. Never destroyed: the interrupt thread may still look at it while the process ends.
struct Unfinished {
  std::mutex mutex;
  std::set<std::string> paths;
};

Unfinished& unfinished() {
  static Unfinished* const all = new Unfinished;
  return *all;
}

[[noreturn]] void cannot_write(const fs::path& target, const std::string& why) {
  throw InputError({target.string()}, "an output that cannot be written (" + why + ")", "a writable place");
}

fs::path make_temporary(const fs::path& folder, const fs::path& target) {
  const std::string pattern = (folder / ("." + target.filename().string() + ".XXXXXX")).string();
  std::vector<char> name(pattern.begin(), pattern.end());
  name.push_back('\0');
  Unfinished& all = unfinished();
  const std::lock_guard lock(all.mutex);
  const int file = ::mkstemp(name.data());
  if (file < 0) cannot_write(target, std::strerror(errno));
  const mode_t mask = ::umask(0);
  ::umask(mask);
  ::fchmod(file, 0666 & ~mask);
  ::close(file);
  all.paths.insert(name.data());
  return name.data();
}

/// For devices and pipes, which std::filesystem does not copy to.
void copy_bytes(const fs::path& from, const fs::path& to) {
  std::ifstream source(from, std::ios::binary);
  std::ofstream target(to, std::ios::binary);
  if (source.peek() != std::ifstream::traits_type::eof()) target << source.rdbuf();
  target.close();
  if (!target) throw std::runtime_error(to.string() + " cannot be written");
}

}  // namespace

OutputFile::OutputFile(const fs::path& target) : target_(target) {
  std::error_code error;
  if (target_.empty() || !target_.has_filename()) cannot_write(target, "it names no file");
  if (fs::is_symlink(target_, error)) target_ = fs::weakly_canonical(target_, error);
  const fs::file_status status = fs::status(target_, error);
  if (fs::is_directory(status)) cannot_write(target, "it is a directory");
  if (fs::exists(status) && ::access(target_.c_str(), W_OK) != 0) cannot_write(target, std::strerror(errno));
  in_place_ = fs::exists(status) && !fs::is_regular_file(status);
  const fs::path folder = in_place_ ? fs::temp_directory_path() : target_.has_parent_path() ? target_.parent_path() : ".";
  temporary_ = make_temporary(folder, target_);
}

OutputFile::~OutputFile() {
  if (temporary_.empty()) return;
  Unfinished& all = unfinished();
  const std::lock_guard lock(all.mutex);
  ::unlink(temporary_.c_str());
  all.paths.erase(temporary_.string());
}

void OutputFile::commit() {
  Unfinished& all = unfinished();
  const std::lock_guard lock(all.mutex);
  if (in_place_) {
    copy_bytes(temporary_, target_);
    ::unlink(temporary_.c_str());
  } else {
    fs::rename(temporary_, target_);
  }
  all.paths.erase(temporary_.string());
  temporary_.clear();
}

void OutputFile::remove_unfinished_and_exit(int status) {
  Unfinished& all = unfinished();
  const std::lock_guard lock(all.mutex);
  for (const std::string& path : all.paths) ::unlink(path.c_str());
  ::_exit(status);
}

std::string require_extension(const fs::path& path, std::initializer_list<const char*> allowed) {
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  std::string listed;
  for (const char* extension : allowed) {
    if (name.size() > std::strlen(extension) && name.ends_with(extension)) return extension;
    listed += (listed.empty() ? "" : " ") + std::string(extension);
  }
  throw InputError({path.string()}, "an unknown extension", "one of " + listed);
}

fs::path numbered_path(const fs::path& path, int number) {
  fs::path stem = path;
  std::string extension;
  do {
    extension = stem.extension().string() + extension;
    stem.replace_extension();
  } while (stem.extension() == ".skel");
  stem += fmt::format(".{:04}{}", number, extension);
  return stem;
}

void write_text(const fs::path& path, std::string_view text) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file) throw std::system_error(errno, std::generic_category(), path.string());
  const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  const int write_error = errno;
  if (std::fclose(file) != 0 || !written)
    throw std::system_error(written ? errno : write_error, std::generic_category(), path.string());
}

}  // namespace cambium
