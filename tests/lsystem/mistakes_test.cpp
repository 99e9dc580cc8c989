// One row for every kind of mistake: where it is said to be, what was found there and what was expected.
#include "grammar.h"
#include "mistake.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

using test::Mistake;

void expect_refused(const Mistake& mistake) {
  const auto error = test::error_of(mistake.text);
  ASSERT_TRUE(error) << mistake.text;
  test::expect_error(*error, mistake, "test.l");
}

TEST(Mistakes, OfFilesAreRefusedWhereTheyStand) {
  const Mistake mistakes[] = {
      {"", 1, 1, "the end of the file", "'lsystem:'"},
      {"axiom: A\n", 1, 1, "'axiom'", "'lsystem:'"},
      {"lsystem 1\n", 1, 9, "'1'", "':' after 'lsystem'"},
      {"lsystem: 1\nendlsystem\n", 1, 1, "an L-system without an axiom", "'axiom:'"},
      {"\n lsystem: 1\naxiom: A\n", 2, 2, "'lsystem:' without an end", "'endlsystem'"},
      {"lsystem: 1\naxiom: A\naxiom: B\nendlsystem\n", 3, 1, "a second axiom", "one"},
      {"lsystem: 1\naxiom:\nendlsystem\n", 2, 7, "the end of the line", "a successor, or '*' for none"},
      {"lsystem: 1\naxiom: A[B\nendlsystem\n", 2, 9, "'[' without an end", "']' in the same successor"},
      {"lsystem: 1\naxiom: A]B\nendlsystem\n", 2, 9, "']'", "a '[' before it"},
      {"lsystem: 1\naxiom: F(1 2)\nendlsystem\n", 2, 12, "'2'", "')' or ','"},
      {"lsystem: 1\nseed: -1\naxiom: A\nendlsystem\n", 2, 7, "-1", "a seed, a whole number from 0"},
      {"lsystem: 1\nseed: 3 4\naxiom: A\nendlsystem\n", 2, 9, "'4'", "the end of the line"},
      {"lsystem: 1\nderivation length: 2.5\naxiom: A\nendlsystem\n", 2, 20, "2.5", "a number of steps, a whole number from 0"},
      {"lsystem: 1\nderivation length: N\naxiom: A\nendlsystem\n", 2, 20, "'N'", "a number, or the name of a parameter or variable"},
      {"lsystem: 1\nderivation length 3\naxiom: A\nendlsystem\n", 2, 19, "'3'", "':' after 'derivation length'"},
      {"lsystem: 1\nring lsystem: 2\naxiom: A\nendlsystem\n", 2, 15, "2", "0 or 1, a whole number from 0"},
      {"lsystem: 1\nmaximum depth: 1000000\naxiom: A\nendlsystem\n", 2, 16, "1000000", "a depth up to 100000, a whole number from 0"},
      {"lsystem: 1\naxiom: A\nhomomorphism maximum depth: 2\nendlsystem\n", 3, 14, "'maximum'", "'warnings', 'no warnings' or the end of the line"},
      {"lsystem: 1\nignore: F\nconsider: A\naxiom: A\nendlsystem\n", 3, 1, "a second list of context symbols", "one"},
      {"lsystem: 1\nignore: F\351\naxiom: A\nendlsystem\n", 2, 10, "byte 0xe9", "a symbol"},
      {"lsystem: 1\ndefine: { int a; }\naxiom: A\nendlsystem\n", 2, 11, "'int'", "'array', 'external' or '}'"},
      {"lsystem: 1\ndefine: { array a[0]; }\naxiom: A\nendlsystem\n", 2, 19, "'0'", "a size of 1 to 1000000 elements in all"},
      {"lsystem: 1\ndefine: { array a; }\naxiom: A\nendlsystem\n", 2, 18, "';'", "'[' and the array's size"},
      {"lsystem: 1\ndefine: { array 2[3]; }\naxiom: A\nendlsystem\n", 2, 17, "'2'", "a name"},
      {"lsystem: 1\ndefine: { array a[2], a[3]; }\naxiom: A\nendlsystem\n", 2, 23, "'a' twice", "different names"},
      {"lsystem: 1\ndefine: { array a[2000][2000]; }\naxiom: A\nendlsystem\n", 2, 25, "'2000'", "a size of 1 to 1000000 elements in all"},
      {"lsystem: 1\ndefine: { array a[1] = {1,2}; }\naxiom: A\nendlsystem\n", 2, 27, "more values than the array holds", "1"},
      {"lsystem: 1\ndefine: { array a[1] = 1; }\naxiom: A\nendlsystem\n", 2, 24, "'1'", "'{' before the array's values"},
      {"lsystem: 1\ndefine: { array a[1] }\naxiom: A\nendlsystem\n", 2, 22, "'}'", "';' after the definition"},
      {"lsystem: 1\ndefine: { external b; }\naxiom: A\nendlsystem\n", 2, 20, "'b'", "a variable of an L-system before this one"},
      {"lsystem: 1\nStart: { x = ; }\naxiom: A\nendlsystem\n", 2, 14, "';'", "an expression"},
      {"lsystem: 1\nStart: { x = 1;\naxiom: A\nendlsystem\n", 3, 6, "':'", "'=' of an assignment"},
      {"lsystem: 1\nStart: { x == 1 }\naxiom: A\nendlsystem\n", 2, 10, "'x'", "a number, or the name of a parameter or variable"},
      {"lsystem: 1\nStart: x = 1;\naxiom: A\nendlsystem\n", 2, 8, "'x'", "'{' before statements"},
      {"lsystem: 1\nStart: { 3 = x; }\naxiom: A\nendlsystem\n", 2, 10, "'3'", "a statement"},
      {"lsystem: 1\nStart: { if x { y = 1; } }\naxiom: A\nendlsystem\n", 2, 13, "'x'", "'(' after 'if'"},
      {"lsystem: 1\nStart: { else x = 1; }\naxiom: A\nendlsystem\n", 2, 15, "'x'", "'=' of an assignment"},
      {"lsystem: 1\nStart: { while (1 { } }\naxiom: A\nendlsystem\n", 2, 19, "'{'", "')' after the condition"},
      {"lsystem: 1\nStart: { do { x = 1; } until (x); }\naxiom: A\nendlsystem\n", 2, 24, "'until'", "'while' after the body of 'do'"},
      {"lsystem: 1\nStart: { do { x = 1; } while (x) }\naxiom: A\nendlsystem\n", 2, 34, "'}'", "';' after 'do'"},
      {"lsystem: 1\nStart: { for (i = 0, i < 3, i = i+1) ; }\naxiom: A\nendlsystem\n", 2, 20, "','", "';' after the first part of 'for'"},
      {"lsystem: 1\nStart: { printf(\"no end); }\naxiom: A\nendlsystem\n", 2, 17, "a text without an end", "'\"'"},
      {"lsystem: 1\nStart: { printf(1); }\naxiom: A\nendlsystem\n", 2, 17, "'1'", "'\"' before a text"},
      {"lsystem: 1\naxiom: A\nendlsystem\nrest", 4, 1, "'rest'", "'lsystem:'"},
      {"lsystem: 1\naxiom: A\nendlsystem rest\n", 3, 12, "'rest'", "the end of the line"},
      {"lsystem: 1 /* no end\naxiom: A\nendlsystem\n", 1, 12, "a comment without an end", "'*/'"},
      {"lsystem: 1\naxiom: \303\244\nendlsystem\n", 2, 8, "byte 0xc3", "a successor, or '*' for none"},
      {"#if 1\nlsystem: 1\naxiom: A\nendlsystem\n", 1, 1, "#if without an end", "#endif"},
      {"lsystem: 1\n #else\naxiom: A\nendlsystem\n", 2, 2, "#else", "an #if before it"},
      {"#if 0\n#else\n#elif 1\n#endif\n", 3, 1, "#elif after #else", "#endif"},
      {"lsystem: 1\n#endif\n", 2, 1, "#endif", "an #if before it"},
      {"#if\n#endif\n", 1, 1, "#if alone", "a condition"},
      {"#if 1 +\n#endif\n", 1, 8, "the end of the line", "an expression"},
      {"#ifdef\n#endif\n", 1, 1, "nothing", "one name"},
      {"#undef A B\n", 1, 8, "'A B'", "one name"},
      {"#define 3\n", 1, 9, "no name", "the name of a macro"},
      {"#define M(a,a) a\n", 1, 13, "'a' twice", "different parameters"},
      {"#define M(a b\n", 1, 13, "'b'", "',' or ')'"},
      {"#define M(a,b) a\nlsystem: 1\naxiom: F(M(1))\nendlsystem\n", 3, 10, "'M' with 1 argument", "2"},
      {"#define M(a) a\nlsystem: 1\naxiom: F(M(1)\nendlsystem\n", 3, 9, "'(' without an end", "')' on the same line"},
      {"#include <stdio.h>\n", 1, 10, "<stdio.h>", "the name of a file in quotes"},
      {"\n  #include \"no such file\"\n", 2, 12, "'no such file', which is no readable file", "an existing file"},
      {"#error stop\n", 1, 1, "#error stop", "a file without #error"},
      {"lsystem: 1\naxiom: ?(9)A$\nendlsystem\nlsystem: 2\naxiom: A\nendlsystem\n", 1, 1, "?(9) in the string", "the label of an L-system of the file"},
  };
  for (const Mistake& mistake : mistakes) expect_refused(mistake);
}

TEST(Mistakes, OfProductionsAreRefusedWhereTheyStand) {
  const Mistake mistakes[] = {
      {"A(s) F(t)", 4, 10, "the end of the line", "'-->'"},
      {"A(s)", 4, 5, "the end of the line", "'-->'"},
      {"A(s --> F(s)", 4, 5, "'-->'", "')' or ','"},
      {"A(1) --> F(1)", 4, 3, "'1'", "the name of a parameter"},
      {"A(s,s) --> F(s)", 4, 5, "parameter 's' twice", "different names"},
      {"A(s) -->", 4, 9, "the end of the line", "a successor, or '*' for none"},
      {"A(s) -> F(s)", 4, 6, "'->'", "'-->'"},
      {"A(s) -o> F(s)", 4, 6, "'-o>', an object production", "'-->'"},
      {"A(s) : s > 1 -o> F(s)", 4, 14, "'-o>', an object production", "'-->'"},
      {"A(s) --> F(s) ?E(s)", 4, 15, "'?E', a question to an environment program", "an L-system that is not open"},
      {"?E(x) --> F(x)", 4, 1, "'?E', a question to an environment program", "an L-system that is not open"},
      {"--> F", 4, 1, "'-->'", "a predecessor"},
      {"A(s) --> F(t)", 4, 12, "'t'", "a number, or the name of a parameter or variable"},
      {"A(s) --> F(sine(s))", 4, 12, "'sine'", "the name of a function"},
      {"A(s) --> F(sin(s,s))", 4, 12, "'sin' with 2 arguments", "1"},
      {"A(s) --> F(nran(s))", 4, 12, "'nran' with 1 argument", "2"},
      {"A(s) --> F(func(1,s))", 4, 12, "'func' without curves", "a .v, .fset or .func file beside the model"},
      {"A(s) --> F(s+)", 4, 14, "')'", "an expression"},
      {"A(s) --> F()", 4, 12, "')'", "an expression"},
      {"A(s) --> F((s)", 4, 11, "'(' without an end", "')' on the same line"},
      {"A(s) --> F(s ? 1)", 4, 17, "')'", "':' of '?'"},
      {"A(s) --> F(1e999)", 4, 12, "'1e999'", "a number within the range of a double"},
      {"A(s) --> F(.)", 4, 12, "'.'", "an expression"},
      {"A(s) --> [F(s)", 4, 10, "'[' without an end", "']' in the same successor"},
      {"A(s) --> F(s)]", 4, 14, "']'", "a '[' before it"},
      {"A(s) --> F(s) : ", 4, 17, "the end of the line", "an expression"},
      {"A(s) --> F(s) \"x\"", 4, 15, "'\"'", "a module, ':' or the end of the line"},
      {"A(s) --> F(s) --> G", 4, 15, "'-->'", "a module, ':' or the end of the line"},
      {"A(s) : --> F(s)", 4, 8, "'-->'", "a condition"},
      {"A(s) : s > --> F(s)", 4, 12, "'-->'", "an expression"},
      {"A(s) : s = 1 --> F(s)", 4, 10, "'='", "'==' or '-->'"},
      {"A(s) : {x=s} s --> F(s)", 4, 12, "'}'", "';' after the statement"},
      {"A(s) : {x=s; s --> F(s)", 4, 16, "'-->'", "';' after the statement"},
      {"< A(s) --> F(s)", 4, 1, "'<'", "a left context before it"},
      {"* --> F", 4, 3, "'-->'", "'<' after '*'"},
      {"B < C < A(s) --> F(s)", 4, 7, "'<'", "'>', ':' or '-->'"},
      {"A(s) > --> F(s)", 4, 8, "'-->'", "a right context"},
      {"A(s) > B > C --> F(s)", 4, 10, "'>'", "':' or '-->'"},
      {"A(s) > B < C --> F(s)", 4, 10, "'<'", "'>', ':' or '-->'"},
      {"[ --> F", 4, 1, "'['", "a predecessor that is no bracket"},
      {"B] < A(s) --> F", 4, 2, "']' in a left context", "modules on the path to the root"},
      {"A(s) --> ~", 4, 10, "'~' alone", "a letter after it"},
      {"A(s) --> @(3)", 4, 10, "'@' alone", "a letter after it"},
      {"A(s) --> F(s/(s-1))", 4, 13, "a division by zero", "a divisor other than 0"},
      {"A(s) : s % 0 == 1 --> F(s)", 4, 10, "a remainder of a division by zero", "a divisor other than 0"},
      {"A(s) --> F(sqrt(-s))", 4, 12, "sqrt(-1)", "arguments for which it is a finite number"},
      {"A(s) --> F(log(0))", 4, 12, "log(0)", "arguments for which it is a finite number"},
      {"A(s) --> F(biran(3,2))", 4, 12, "biran(3,2)", "arguments for which it is a finite number"},
      {"A(s) --> F(1e300*s*1e300)", 4, 19, "a number that is not finite", "an expression within the range of a double"},
      {"A(s) --> F(s) : -1", 4, 17, "a negative weight", "a weight of 0 or more"},
      {"A(s) : {while (1) x = 1;} * --> F(s)", 4, 9, "a loop that does not end", "fewer than 4000000 operations for one module"},
      {"A(s) : {q[2] = 1;} * --> F(s)", 4, 14, "'='", "'[' and an index"},
      {"A(s) --> F(q[s,5])", 4, 12, "index 5 of 'q'", "0 to 2"},
      {"A(s) --> F(q[s-2,0])", 4, 12, "index -1 of 'q'", "0 to 1"},
      {"A(s) --> F(q[s])", 4, 16, "')'", "'[' and an index"},
      {"A(s) --> F(q[1,1,1])", 4, 18, "'1'", "']'"},
      {"A(s) : {q = 1;} * --> F(s)", 4, 11, "'='", "'[' and an index"},
      {"A(s) --> F(s) G(s", 4, 16, "'(' without an end", "')' on the same line"},
  };
  for (Mistake mistake : mistakes) {   // the production is line 4
    mistake.text = "lsystem: 1\ndefine: { array q[2,3]; }\naxiom: A(1)\n" + mistake.text + "\nendlsystem\n";
    expect_refused(mistake);
  }
}

}  // namespace
}  // namespace cambium
