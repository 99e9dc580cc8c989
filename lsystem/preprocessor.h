// The C preprocessor, as far as L-system files use it: comments, line splices, #define, #undef, #include, #if.
#pragma once

#include "lsystem/source_text.h"

#include <filesystem>
#include <string_view>

namespace cambium {

/// Text with comments gone (each a space), directives obeyed and macros expanded. Characters of a macro's body get the place of
/// its invocation, those of its arguments keep their own. `#` is a directive only before one of C's directive names, since it is
/// a turtle symbol too. `#include "name"` is read relative to the including file.
/// Errors: InputError. Bounded: 64 levels of nesting, 4 million characters.
SourceText preprocess(std::string_view text, const std::filesystem::path& file);

/// Contents of a file; InputError if it cannot be read or is larger than 16 MB.
std::string read_source(const std::filesystem::path& file, const SourceLocation& wanted_from);

}  // namespace cambium
