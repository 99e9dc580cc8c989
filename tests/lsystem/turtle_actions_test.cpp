#include "lsystem/turtle_actions.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

TEST(TurtleActions, SeveralSymbolsMayMeanOneAction) {
  EXPECT_EQ(turtle_action("F"), TurtleAction::kDraw);
  EXPECT_EQ(turtle_action("$"), turtle_action("@v"));
  EXPECT_EQ(turtle_action("~a"), turtle_action("~b"));
}

TEST(TurtleActions, WhatTheTurtleDoesNotKnowIsSkipped) {
  for (const char* symbol : {"A", "@L", "", "FF", "?Q"}) EXPECT_EQ(turtle_action(symbol), TurtleAction::kSkip) << symbol;
}

}  // namespace
}  // namespace cambium
