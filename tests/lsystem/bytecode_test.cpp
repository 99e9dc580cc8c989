#include "lsystem/bytecode.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

Code code_of(std::vector<CodeInstruction> instructions, std::vector<double> constants, std::size_t stack_size) {
  Code code;
  code.instructions = std::move(instructions);
  code.constants = std::move(constants);
  for (std::uint32_t i = 0; i < code.instructions.size(); ++i) code.places.push_back({7, i + 1, 0});
  code.stack_size = stack_size;
  return code;
}

class Bytecode : public testing::Test {
 protected:
  int column_of_error(const Code& code) {
    try {
      machine.run(code, locals);
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().line, 7);
      return error.location().column;
    }
    return 0;
  }

  CodeTables tables{{"test.l"}, {{"a", 0, {2, 3}}}, {}};
  CounterRandom random{1};
  std::vector<double> globals;
  std::string printed;
  Printer printer = [this](std::string_view text) { printed += text; };
  Machine machine{tables, random, globals, &printer};
  double locals[4] = {10, 20, 30, 40};
};

TEST_F(Bytecode, LeavesItsValuesBottomFirst) {
  const Code code = code_of({{Opcode::kLocal, 1}, {Opcode::kConstant, 0}, {Opcode::kLocal, 0}, {Opcode::kSubtract}}, {3}, 3);
  const double* values = machine.run(code, locals);
  EXPECT_EQ(values[0], 20);
  EXPECT_EQ(values[1], -7);
  EXPECT_GE(machine.work, 4u);
}

TEST_F(Bytecode, ElementsAreCheckedAgainstTheArraysSizes) {
  globals = {0, 1, 2, 3, 4, 5};
  const std::vector<CodeInstruction> load = {{Opcode::kConstant, 0}, {Opcode::kConstant, 1}, {Opcode::kElement, 0}};
  EXPECT_EQ(machine.value(code_of(load, {1, 2}, 2), locals), 5);
  EXPECT_EQ(column_of_error(code_of(load, {1, 3}, 2)), 3);
  EXPECT_EQ(column_of_error(code_of(load, {-1, 0}, 2)), 3);
  const std::vector<CodeInstruction> store = {{Opcode::kConstant, 0}, {Opcode::kConstant, 1}, {Opcode::kLocal, 3}, {Opcode::kStoreElement, 0}};
  machine.run(code_of(store, {0, 1}, 3), locals);
  EXPECT_EQ(globals[1], 40);
}

TEST_F(Bytecode, ErrorsNameTheInstruction) {
  EXPECT_EQ(column_of_error(code_of({{Opcode::kConstant, 0}, {Opcode::kConstant, 0}, {Opcode::kDivide}}, {0}, 2)), 3);
  EXPECT_EQ(column_of_error(code_of({{Opcode::kConstant, 0}, {Opcode::kConstant, 0}, {Opcode::kMultiply}}, {1e200}, 2)), 3);
  EXPECT_NE(column_of_error(code_of({{Opcode::kJump, 0}}, {}, 0)), 0);  // never ends
}

TEST_F(Bytecode, PrintingTakesItsValuesAndLeavesZero) {
  Code code = code_of({{Opcode::kLocal, 0}, {Opcode::kLocal, 1}, {Opcode::kPrint, 0}}, {}, 2);
  code.prints = {{"%g of %g\\n", 2}};
  EXPECT_EQ(machine.value(code, locals), 0);
  EXPECT_EQ(printed, "10 of 20\n");
}

TEST_F(Bytecode, CurvesAreCountedFromOne) {
  tables.curves.emplace_back("up", std::vector<CurvePoint>{{0, 0}, {1.0 / 3, 1}, {2.0 / 3, 2}, {1, 3}}, 0);
  const Code code = code_of({{Opcode::kLocal, 0}, {Opcode::kConstant, 0}, {Opcode::kCall, static_cast<std::uint32_t>(Function::kFunc) | 2u << 8}}, {0.5}, 2);
  locals[0] = 1;
  EXPECT_NEAR(machine.value(code, locals), 1.5, 1e-12);
  locals[0] = 2;
  EXPECT_EQ(column_of_error(code), 3);
}

TEST_F(Bytecode, FunctionsAreFoundByName) {
  ASSERT_NE(find_function("atan2"), nullptr);
  EXPECT_EQ(find_function("atan2")->arity, 2);
  EXPECT_EQ(find_function("Sin"), nullptr);
}

}  // namespace
}  // namespace cambium
