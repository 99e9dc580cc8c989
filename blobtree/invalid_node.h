// The error of a node that is not legal.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace cambium {

/// A node whose numbers or children are not legal. key names the offending member as in BlobTree JSON.
class InvalidNode : public std::invalid_argument {
 public:
  InvalidNode(std::string key, std::string found, std::string expected)
      : std::invalid_argument(key + ": found " + found + ", expected " + expected),
        key_(std::move(key)), found_(std::move(found)), expected_(std::move(expected)) {}
  const std::string& key() const { return key_; }
  const std::string& found() const { return found_; }
  const std::string& expected() const { return expected_; }

 private:
  std::string key_, found_, expected_;
};

}  // namespace cambium
