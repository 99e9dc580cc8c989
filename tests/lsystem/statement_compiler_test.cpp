#include "grammar.h"
#include "lsystem/expression_compiler.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

using test::derived_text;
using test::grammar;

// The variable `r` after a block.
double result_of(const std::string& block) {
  return test::derived(test::parsed(grammar("A", "A : " + block + " * --> F(r)")), 1).parameters.at(0);
}

TEST(StatementCompiler, StatementsRunAsInC) {
  EXPECT_EQ(result_of("{ r = 1; if (r > 2) r = 5; else { r = 7; r += 1; } }"), 8);
  EXPECT_EQ(result_of("{ r = 0; i = 0; while (i < 5) { r = r + i; i += 1; } }"), 10);
  EXPECT_EQ(result_of("{ r = 1; for (i = 0; i < 10; i = i + 1) r *= 2; printf(\"%g\\n\", r); }"), 1024);
  EXPECT_EQ(result_of("{ r = 3; do { r -= 1; } while (r > 10); }"), 2);
  EXPECT_EQ(result_of("{ r = 0; do r += 1; while (r < 4); r /= 8; }"), 0.5);
}

TEST(StatementCompiler, CallsOfFilesAndSoundsAreReadAndDropped) {
  EXPECT_EQ(result_of("{ fp = fopen(\"out.txt\", \"w\"); fprintf(fp, \"%g\", 3); fclose(fp); stop(1); r = 2; }"), 2);
}

TEST(StatementCompiler, DeepNestingIsAnErrorNotACrash) {
  EXPECT_THROW(result_of(std::string(100000, '{')), InputError);
}

}  // namespace
}  // namespace cambium
