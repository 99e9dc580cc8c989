// L-Py files: models that come out as their cpfg twins, and what is refused where.
#include <gtest/gtest.h>

#include "grammar.h"
#include "mistake.h"
#include "lsystem/lpy_symbols.h"

namespace cambium {
namespace {

LSystem lpy(const std::string& text) { return LSystem::parse(text, "test.lpy", std::nullopt, Dialect::kLpy); }

std::string lpy_text(const std::string& text, int steps) { return to_text(test::derived(lpy(text), steps)); }

TEST(DialectLpy, KochIsAsInCpfg) {
  const std::string koch = lpy_text("Axiom: F++F++F\nderivation length: 3\nproduction:\nF --> F-F++F-F\nendlsystem\n", 3);
  EXPECT_EQ(koch, test::derived_text(test::grammar("F++F++F", "F-->F-F++F-F"), 3));
}

TEST(DialectLpy, TheMonopodialTreeOfTheBookHasTheSkeletonOfItsCpfgTwin) {
  const char* const kLpy =
      "# ABOP 2.6\nr1 = 0.9\nr2 = 0.6\na0 = 45\na2 = 45\nd = 137.5\nwr = .707\nmodule A(l,w), B(l,w), C(l,w)\n"
      "Axiom: A(1,10)\nderivation length: 6\nproduction:\n"
      "A(l,w) --> SetWidth(w/2)F(l)[&(a0)B(l*r2,w*wr)]\\(d)A(l*r1,w*wr)\n"
      "B(l,w) --> SetWidth(w/2.)F(l)[-(a2)@vC(l*r2,w*wr)]C(l*r1,w*wr)\n"
      "C(l,w) --> SetWidth(w/2.)F(l)[+(a2)@vB(l*r2,w*wr)]B(l*r1,w*wr)\nendlsystem\n";
  const std::string cpfg = test::grammar("A(1,10)",
                                         "A(l,w) --> !(w)F(l)[&(45)B(l*0.6,w*.707)]/(137.5)A(l*0.9,w*.707)\n"
                                         "B(l,w) --> !(w)F(l)[-(45)@vC(l*0.6,w*.707)]C(l*0.9,w*.707)\n"
                                         "C(l,w) --> !(w)F(l)[+(45)@vB(l*0.6,w*.707)]B(l*0.9,w*.707)");
  const LSystem one = lpy(kLpy), other = test::parsed(cpfg);
  const Turtled a = interpret(test::derived(one, 6), one, {}, {}).value();
  const Turtled b = interpret(test::derived(other, 6), other, {}, {}).value();
  ASSERT_EQ(a.skeleton.nodes.size(), b.skeleton.nodes.size());
  EXPECT_GT(a.skeleton.nodes.size(), 60u);
  for (std::size_t i = 0; i < a.skeleton.nodes.size(); ++i) {
    EXPECT_LT(glm::length(a.skeleton.nodes[i].position - b.skeleton.nodes[i].position), 1e-12);
    EXPECT_NEAR(a.skeleton.nodes[i].radius, b.skeleton.nodes[i].radius, 1e-12);
  }
}

TEST(DialectLpy, BodiesThatChooseWhatToProduceAreRulesWithConditions) {
  const char* const kText =
      "Imax = 3\nAxiom: A(0)\nproduction:\nA(t):\n  if t >= Imax:\n    produce B\n  elif t == 1:\n    produce I(t)[+A(t+1)]A(t+1)\n"
      "  else:\n    produce A(t+1)\nB : produce *\nendlsystem\n";
  EXPECT_EQ(lpy_text(kText, 1), "A(1)");
  EXPECT_EQ(lpy_text(kText, 2), "I(1)[+A(2)]A(2)");
  EXPECT_EQ(lpy_text(kText, 4), "I(1)[+B]B");
  EXPECT_EQ(lpy_text(kText, 5), "I(1)[+]");
}

TEST(DialectLpy, ABodyThatProducesNothingLeavesTheModuleToTheNextRule) {
  const char* const kText = "Axiom: A(0)A(5)\nproduction:\nA(t):\n  if t > 3: produce C\nA(t) --> D(t)\nendlsystem\n";
  EXPECT_EQ(lpy_text(kText, 1), "D(0)C");
}

TEST(DialectLpy, ConditionsBeforeTheArrowArePythons) {
  const char* const kText =
      "Axiom: A(1)A(2)A(3)A(7)\nproduction:\nA(x) : not x == 2 and 0 < x < 5 --> B(x**2**0.5, -x**2, x//2, -x%3)\nendlsystem\n";
  EXPECT_EQ(lpy_text(kText, 1), "B(1,-1,0,2)A(2)B(4.72880439,-9,1,0)A(7)");
}

TEST(DialectLpy, TheLongestNameIsTheModule) {
  EXPECT_EQ(lpy_text("module Apex\nAxiom: Apex(1)Apx\nproduction:\nApex(x) --> Left(x)RollL(1)App\nendlsystem\n", 1), "+(1)/(1)AppApx");
  LpySymbols symbols;
  symbols.declare("In");
  symbols.declare("Internode");
  const SourceText source{"InternodeInIt", {}, {}, {"test.lpy"}};
  Cursor in(source);
  EXPECT_EQ(symbols.read(in), "Internode");
  EXPECT_EQ(symbols.read(in), "In");
  EXPECT_EQ(symbols.read(in), "I");
}

TEST(DialectLpy, ContextsMatchAndIgnoredModulesAreLookedOver) {
  EXPECT_EQ(lpy_text("module Node\nAxiom: S+Node(1)Node(2)\nignore: + -\nproduction:\nS < Node(x) --> S\nNode(x) > Node(y) --> T\nendlsystem\n", 1),
            "S+SNode(2)");
  EXPECT_EQ(lpy_text("module Node, Name\nAxiom: S Name Node\nconsider: S Node\nproduction:\nS < Node --> S\nendlsystem\n", 1), "SNameS");
}

TEST(DialectLpy, StringsGoOnInDeeperLines) {
  EXPECT_EQ(lpy_text("Axiom: A\n  B\n  C\nproduction:\nA:\n  produce D\n     E\nB --> F\n  G\nendlsystem\n", 1), "DEFGC");
}

TEST(DialectLpy, DecompositionAndInterpretationAreSections) {
  const LSystem system = lpy(
      "Axiom: A\nderivation length: 1\nproduction:\nA --> B\ndecomposition:\nmaximum depth: 2\nB --> C\nC --> D\ninterpretation:\nD --> F(2)\nendlsystem\nrest of Python: [\n");
  const ModuleString string = test::derived(system, 1);
  EXPECT_EQ(to_text(string), "D");
  EXPECT_DOUBLE_EQ(interpret(string, system, {}, {})->total_length, 2);
}

TEST(DialectLpy, OneStepIsDerivedWhereTheFileDoesNotSay) {
  const auto string = derive(lpy("Axiom: A\nproduction:\nA --> AA\nendlsystem\n"), {}, {});
  EXPECT_EQ(to_text(*string), "AA");
}

TEST(DialectLpy, FunctionsOfMathTakeRadians) {
  EXPECT_EQ(lpy_text("from math import *\nx = 2*sin(pi/6)\nAxiom: A(x, max(1,2), degrees(pi), atan2(1,1)*4/pi)\nproduction:\nendlsystem\n", 0),
            "A(1,2,180,1)");
}

using test::expect_error;
using test::Mistake;

TEST(DialectLpy, WhatIsNoRuleIsRefusedWhereItStands) {
  const Mistake mistakes[] = {
      {"", 1, 1, "the end of the file", "'Axiom:'"},
      {"def f(x):\n  return x\n", 1, 1, "'def', which is embedded Python", "docs/lsystems.md"},
      {"import math\n", 1, 1, "'import'", "docs/lsystems.md"},
      {"from random import *\n", 1, 1, "'from random'", "docs/lsystems.md"},
      {"Axiom: A\nclass B: pass\n", 2, 1, "'class'", "docs/lsystems.md"},
      {"x = [1,2]\n", 1, 5, "'['", "lists, texts and the like are Python"},
      {"x = {}\n", 1, 5, "'{'", "lists, texts"},
      {"x = 'a'\n", 1, 5, "'''", "lists, texts"},
      {"x = y\n", 1, 5, "'y'", "a number assigned before the axiom"},
      {"x = 1 +\n", 1, 8, "the end of the line", "an expression"},
      {"x = 1 / 0\n", 1, 7, "a division by zero", "a divisor other than 0"},
      {"x = 0x10\n", 1, 5, "'0x10'", "a decimal number"},
      {"x = math.pi\n", 1, 9, "'.'", "attributes are Python"},
      {"x = len(3)\n", 1, 5, "'len('", "abs, float"},
      {"x = sin(3)\n", 1, 5, "'sin('", "from math import"},
      {"x = max(1)\n", 1, 5, "'max' of 1", "2"},
      {"x = (1\n", 1, 5, "'('", "')'"},
      {"x = 1 if 2\n", 1, 11, "the end of the line", "'else'"},
      {"x = 1 2\n", 1, 7, "'2'", "the end of the line"},
      {"  x = 1\n", 1, 3, "'x'", "beginning of the line"},
      {"Axiom: A(\n", 2, 1, "the end of the file", "an expression"},
      {"Axiom: A(1\n", 1, 9, "'('", "')'"},
      {"Axiom: A(lambda)\n", 1, 10, "'lambda'", "this is Python"},
      {"Axiom: A(1 2)\n", 1, 12, "'2'", "')' or ','"},
      {"Axiom: A[B\nproduction:\nendlsystem\n", 1, 9, "'['", "']'"},
      {"Axiom: 3\n", 1, 8, "'3'", "a module"},
      {"Axiom: A\nAxiom: B\n", 2, 1, "a second axiom", "one"},
      {"Axiom:\n  nproduce A\n", 2, 3, "'nproduce'", "docs/lsystems.md"},
      {"Axiom: @x\n", 1, 8, "'@'", "names that L-Py gives"},
      {"Axiom: A\nderivation steps: 3\n", 2, 12, "'steps'", "'length'"},
      {"Axiom: A\nderivation length 3\n", 2, 19, "'3'", "':'"},
      {"Axiom: A\nderivation length: 2.5\n", 2, 20, "2.5", "a whole number"},
      {"Axiom: A\nA --> B\n", 2, 1, "'A'", "'production:'"},
      {"Axiom: A\nproduction:\nx = 3\n", 3, 1, "'x ='", "docs/lsystems.md"},
      {"Axiom: A\nproduction:\nA\n", 3, 2, "the end of the line", "':' or '-->'"},
      {"Axiom: A\nproduction:\nA --> B)\n", 3, 8, "')'", "a module"},
      {"Axiom: A\nproduction:\nA(x) --> B(y)\n", 3, 12, "'y'", "a parameter of the rule"},
      {"Axiom: A\nproduction:\nA(1) --> B\n", 3, 3, "'1'", "the name of a parameter"},
      {"Axiom: A\nproduction:\nA(x,x) --> B\n", 3, 5, "'x' twice", "different names"},
      {"Axiom: A\nproduction:\nA(*x) --> B\n", 3, 3, "'*'", "the name of a parameter"},
      {"Axiom: A\nproduction:\nA << B --> C\n", 3, 3, "'<<'", "'<' or '>'"},
      {"Axiom: A\nproduction:\nA >> B --> C\n", 3, 3, "'>>'", "'<' or '>'"},
      {"Axiom: A\nproduction:\n* < B --> C\n", 3, 1, "'*'", "patterns of L-Py"},
      {"Axiom: A\nproduction:\nA -static-> C\n", 3, 3, "'-static->'", "docs/lsystems.md"},
      {"Axiom: A\nproduction:\nA:\nB --> C\n", 3, 3, "the end of the line", "an indented body"},
      {"Axiom: A\nproduction:\nA:\n  nproduce B\n", 4, 3, "'nproduce'", "docs/lsystems.md"},
      {"Axiom: A\nproduction:\nA:\n  for i in range(3):\n", 4, 3, "'for'", "docs/lsystems.md"},
      {"Axiom: A\nproduction:\nA(x):\n  x += 1\n  produce A(x)\n", 4, 3, "'x', which is embedded Python", "'produce', 'if' or 'pass'"},
      {"Axiom: A\nproduction:\nA:\n  else: produce B\n", 4, 3, "'else'", "'produce', 'if' or 'pass'"},
      {"Axiom: A\nproduction:\nA:\n  if 1 produce B\n", 4, 8, "'produce'", "':' after the condition"},
      {"Axiom: A\nproduction:\nA:\n  if 1: produce B\n   pass\n", 5, 4, "'pass'", "docs/lsystems.md"},
      {"Axiom: A\nproduction:\nA:\n  if 1: pass\n   pass\n", 5, 4, "'pass'", "indented as the one before it"},
      {"Axiom: A\nproduction:\nA(x) : x > --> B\n", 3, 12, "'-->'", "an expression"},
      {"Axiom: A\nproduction:\nA(x) : x = 3 --> B\n", 3, 10, "'='", "'-->'"},
      {"Axiom: A\nproduction:\ngroup 1:\n", 3, 1, "'group'", "rules without groups"},
      {"module 3\n", 1, 8, "'3'", "the name of a module"},
      {"module A(x\n", 1, 9, "'('", "')'"},
      {"Axiom: A\nignore: 3\n", 2, 9, "'3'", "a module's name"},
      {"Axiom: A\n\"\"\" no end\n", 2, 1, "a text without an end", "\"\"\""},
  };
  for (const Mistake& mistake : mistakes) {
    try {
      const LSystem system = lpy(mistake.text);
      ADD_FAILURE() << mistake.text << "\nis read as " << to_text(test::derived(system, 0));
    } catch (const InputError& error) {
      expect_error(error, mistake, "test.lpy");
    }
  }
}

}  // namespace
}  // namespace cambium
