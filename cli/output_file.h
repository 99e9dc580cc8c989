// Output that is either there whole or not at all: written beside its place, then renamed.
#pragma once

#include <filesystem>
#include <string>

namespace cambium {

/// One output of a command. Made before the long work starts, so that a place that cannot be written to is known at once.
class OutputFile {
 public:
  /// Makes an empty temporary file beside `target` (in the system's temporary folder if target is a device or a pipe).
  /// Errors: InputError naming target if it cannot be written.
  explicit OutputFile(const std::filesystem::path& target);
  ~OutputFile();  ///< removes the temporary file unless committed
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Where to write to.
  const std::filesystem::path& temporary() const { return temporary_; }

  /// Moves what was written to the target. Errors: std::exception naming the target.
  void commit();

  /// Ends the process at once; temporary files of this process that are not committed are removed first.
  [[noreturn]] static void remove_unfinished_and_exit(int status);

 private:
  std::filesystem::path target_;
  std::filesystem::path temporary_;
  bool in_place_ = false;  ///< the target is no regular file: its bytes are copied, not renamed
};

/// The extension of `path` in lower case if it is one of `allowed` (with their dots; ".skel.json" counts as one).
/// Errors: InputError naming the path.
std::string require_extension(const std::filesystem::path& path, std::initializer_list<const char*> allowed);

/// The name of one of many: tree.png has tree.0007.png, tree.skel.json tree.0007.skel.json.
std::filesystem::path numbered_path(const std::filesystem::path& path, int number);

/// Writes all of `text` to `path`. Errors: std::system_error naming the path.
void write_text(const std::filesystem::path& path, std::string_view text);

}  // namespace cambium
