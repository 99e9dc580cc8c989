// A table of malformed texts with the place that each error must name.
#pragma once

#include "blobtree/input_error.h"

#include <gtest/gtest.h>

#include <string>

namespace cambium {

struct Malformed {
  const char* text;
  int line, column;
  const char* in_message;
};

template <class Parse>
void expect_refused(const Malformed& bad, Parse parse) {
  SCOPED_TRACE(bad.text);
  try {
    parse(bad.text, "some.file");
    FAIL() << "was read";
  } catch (const InputError& error) {
    EXPECT_EQ(error.location().file, "some.file");
    EXPECT_EQ(error.location().line, bad.line) << error.what();
    EXPECT_EQ(error.location().column, bad.column) << error.what();
    EXPECT_NE(std::string(error.what()).find(bad.in_message), std::string::npos) << error.what();
    EXPECT_FALSE(error.found().empty());
    EXPECT_FALSE(error.expected().empty());
  }
}

}  // namespace cambium
