// A row of a table of mistakes in a file, and what the user is to read of it.
#pragma once

#include "blobtree/input_error.h"

#include <gtest/gtest.h>

#include <string>

namespace cambium::test {

struct Mistake {
  std::string text;
  int line, column;
  const char* found;      // parts of the message
  const char* expected;
};

inline void expect_error(const InputError& error, const Mistake& mistake, const std::string& file) {
  SCOPED_TRACE(mistake.text + "\n" + error.what());
  EXPECT_EQ(error.location().file, file);
  EXPECT_EQ(error.location().line, mistake.line);
  EXPECT_EQ(error.location().column, mistake.column);
  EXPECT_NE(error.found().find(mistake.found), std::string::npos);
  EXPECT_NE(error.expected().find(mistake.expected), std::string::npos);
}

}  // namespace cambium::test
