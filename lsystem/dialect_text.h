// Pieces of cpfg's language that know where in a file of another dialect they come from.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "lsystem/macro_expansion.h"
#include "lsystem/source_text.h"

namespace cambium {

/// A file as it stands, every character with its place; only a byte order mark and carriage returns are dropped.
SourceText as_it_stands(std::string_view text, const std::filesystem::path& file);

/// All of `text` is at one place.
void append(MarkedText& to, std::string_view text, const Place& place);
inline void append(MarkedText& to, const MarkedText& piece) { to.insert(to.end(), piece.begin(), piece.end()); }
/// A symbol that ModuleParser reads as this name, whatever it looks like.
void append_symbol(MarkedText& to, std::string_view name, const Place& place);
/// A number of the same value, in parentheses if it is negative.
void append_number(MarkedText& to, double value, const Place& place);

/// What cpfg's parser reads. Errors: InputError if it has grown beyond 4 million characters.
SourceText marked_source(const MarkedText& text, const SourceText& from);

/// The value of an expression of constants, as cpfg has it. Errors: InputError.
double constant_of(const MarkedText& expression, const SourceText& from);

}  // namespace cambium
