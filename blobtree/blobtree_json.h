// BlobTree JSON (formats.md), in and out. Reading what was written gives the same field bit for bit; Attributes are not
// part of the format. Nests of any depth cost no call stack.
#pragma once

#include "blobtree/blobtree.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace cambium {

/// Errors: InputError at the offending value: JSON, keys, kinds of value and everything InvalidNode stands for.
BlobTree read_blobtree(const std::filesystem::path& path);
BlobTree parse_blobtree(std::string_view text, const std::string& file);

/// Numbers in shortest round-trip form, one primitive per line.
std::string to_json(const BlobTree& tree);
/// Writes beside and renames. Errors: std::runtime_error naming the path.
void write_blobtree(const BlobTree& tree, const std::filesystem::path& path);

}  // namespace cambium
