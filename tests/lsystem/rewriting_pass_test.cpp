#include "lsystem/rewriting_pass.h"

#include <gtest/gtest.h>

#include <atomic>

#include "grammar.h"

namespace cambium {
namespace {

using test::grammar;
using test::parsed;

ModuleString with_threads(const LSystem& system, int steps, int threads) {
  DeriveOptions options;
  options.steps = steps;
  options.seed = 3;
  RunOptions run;
  run.threads = threads;
  return derive(system, options, run).value();
}

void expect_equal(const ModuleString& a, const ModuleString& b, const std::string& what) {
  EXPECT_EQ(a.symbol, b.symbol) << what;
  EXPECT_EQ(a.first, b.first) << what;
  EXPECT_EQ(a.parameters, b.parameters) << what;
  EXPECT_EQ(a.key, b.key) << what;
  EXPECT_EQ(a.variables, b.variables) << what;
}

TEST(RewritingPass, TheStringIsTheSameForAnyNumberOfThreads) {
  struct Row {
    const char* axiom;
    const char* productions;
    int steps;
    const char* settings;
  };
  const Row rows[] = {
      {"A(1)", "A(s) --> F(s)[+(ran(90))A(s/2)][-(60)A(s/2)]", 15, ""},
      {"A", "A --> F[+A]A : 0.7\nA --> FA[-A] : 0.3\nF --> FF", 14, ""},
      {"A(0)", "A(n) --> B[&A(n+1)][^A(n)]\nB < A(n) : ran(1) < 0.9 --> FB[A(n)]A(n+1)\nB > [&=][^A(n)=] --> C(n)", 15,
       "ignore: &^"},
      {"A",
       "A --> I(1)[+A]A\nI(x) > [+I(y)=]I(z) --> I(y+z)\ndecomposition\nmaximum depth: 4\nI(x) : ran(x) > 1 --> FI(x/2)", 15,
       "consider: I+[]"},
      {"AA", "A --> AB\nAA --> B[%A]A\nB --> AA", 17, ""},
      {"A", "A : { n = n+1; } * --> A[B(n)]A", 16, "Start: { n = 0; }"},
      {"A", "A --> A[A%B]A", 10, ""},
      {"A", "A --> A[?(2)B$]A\nendlsystem\nlsystem: 2\naxiom: B\nB --> C(ran(1))BB", 12, ""},
  };
  for (const Row& row : rows) {
    const LSystem system = parsed(grammar(row.axiom, row.productions, row.settings));
    const ModuleString one = with_threads(system, row.steps, 1);
    EXPECT_GT(one.size(), 40'000u) << row.productions;  // several waves of chunks
    for (const int threads : {2, 3, 7}) expect_equal(with_threads(system, row.steps, threads), one, row.productions);
  }
}

TEST(RewritingPass, ErrorsAreTheFirstInTheStringForAnyNumberOfThreads) {
  const LSystem dividing = parsed(grammar("A(1)",
                                          "A(n) : n < 60000 --> A(2*n)A(2*n+1)\nA(n) : n > 90000 --> F(n/(n-n))\n"
                                          "A(n) --> F(1/(n-81234))G(1/(n-71234))"));
  const LSystem growing =
      parsed(grammar("A(1)", "A(n) : n < 60000 --> A(2*n)A(2*n+1)\nA(n) : n > 70000 --> AAAAAA\nA(n) --> AA"));
  for (const int threads : {1, 2, 5}) {
    RunOptions run;
    run.threads = threads;
    DeriveOptions options;
    options.steps = 17;
    try {
      derive(dividing, options, run);
      ADD_FAILURE();
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().line, 6) << threads;
      EXPECT_EQ(error.location().column, 27) << threads;  // 71234 stands before 81234
    }
    options.max_modules = 131'000;
    try {
      derive(growing, options, run);
      ADD_FAILURE();
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().line, 5) << threads;
    }
  }
}

TEST(RewritingPass, ALimitHoldsExactly) {
  const LSystem system = parsed(grammar("A", "A --> AA"));
  DeriveOptions options;
  options.steps = 16;
  options.max_modules = 65536;
  for (const int threads : {1, 2}) {
    RunOptions run;
    run.threads = threads;
    options.max_modules = 65536;
    EXPECT_EQ(derive(system, options, run)->size(), 65536u);
    options.max_modules = 65535;
    EXPECT_THROW(derive(system, options, run), InputError);
  }
}

TEST(RewritingPass, ADecompositionThatExplodesIsStopped) {
  const LSystem wide = parsed(grammar("A", "B --> B\ndecomposition\nmaximum depth: 1000\nA --> AA"));
  DeriveOptions options;
  options.steps = 1;
  options.max_modules = 10000;
  EXPECT_THROW(derive(wide, options, {}), InputError);
  // Nothing is left of it, but it takes for ever.
  const LSystem empty = parsed(grammar("A", "B --> B\ndecomposition\nmaximum depth: 60\nA --> AA\nA --> *"));
  std::atomic<bool> cancel{true};
  RunOptions run;
  run.cancel = &cancel;
  EXPECT_FALSE(derive(empty, options, run));
}

TEST(RewritingPass, ModulesTakeFourteenBytes) {
  const ModuleString string = with_threads(parsed(grammar("A", "A --> F[+A][-A]")), 16, 1);
  const double bytes =
      static_cast<double>(string.symbol.capacity() * 2 + string.first.capacity() * 4 + string.key.capacity() * 8);
  EXPECT_LT(bytes / static_cast<double>(string.size()), 24);
}

}  // namespace
}  // namespace cambium
