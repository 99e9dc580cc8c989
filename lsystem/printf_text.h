// What cpfg's printf writes.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace cambium {

/// `format` as it stands between its quotes, `\n` and the like still spelled out. Conversions of whole numbers round towards
/// zero; one without a value takes 0, values beyond the last conversion are dropped. `%s` and what C does not know is kept
/// as it is.
std::string printf_text(std::string_view format, const double* values, std::size_t count);

}  // namespace cambium
