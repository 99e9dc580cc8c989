// The one error a user's input can cause. Libraries throw it; only the command line prints it.
#pragma once

#include <stdexcept>
#include <string>

namespace cambium {

/// A place in a text file. line and column count from 1; 0 means unknown (then it is not printed).
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;
};

/// Bad input: where it is, what was found and what was expected. what() is the one line that the user reads:
/// `file:line:column: found X, expected Y`.
class InputError : public std::runtime_error {
 public:
  InputError(SourceLocation location, std::string found, std::string expected);

  const SourceLocation& location() const { return location_; }
  const std::string& found() const { return found_; }
  const std::string& expected() const { return expected_; }

 private:
  SourceLocation location_;
  std::string found_;
  std::string expected_;
};

}  // namespace cambium
