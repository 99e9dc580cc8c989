#include "lsystem/bytecode.h"

#include "lsystem/printf_text.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

namespace cambium {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

constexpr FunctionInfo kFunctions[] = {
    {"sin", Function::kSin, 1},     {"cos", Function::kCos, 1},     {"tan", Function::kTan, 1},
    {"asin", Function::kAsin, 1},   {"acos", Function::kAcos, 1},   {"atan", Function::kAtan, 1},
    {"atan2", Function::kAtan2, 2}, {"exp", Function::kExp, 1},     {"log", Function::kLog, 1},
    {"sqrt", Function::kSqrt, 1},   {"floor", Function::kFloor, 1}, {"ceil", Function::kCeil, 1},
    {"trunc", Function::kTrunc, 1}, {"fabs", Function::kFabs, 1},   {"sign", Function::kSign, 1},
    {"min", Function::kMin, 2},     {"max", Function::kMax, 2},     {"pow", Function::kPow, 2},
    {"ran", Function::kRan, 1},     {"nran", Function::kNran, 2},   {"bran", Function::kBran, 2},
    {"biran", Function::kBiran, 2}, {"srand", Function::kSrand, 1}, {"func", Function::kFunc, 2},
};

std::string_view name_of(Function function) {
  for (const FunctionInfo& info : kFunctions)
    if (info.function == function) return info.name;
  return "function";
}

std::string number_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

}  // namespace

const FunctionInfo* find_function(std::string_view name) {
  for (const FunctionInfo& info : kFunctions)
    if (info.name == name) return &info;
  return nullptr;
}

double Machine::call(Function function, const double* a) {
  switch (function) {
    case Function::kSin: return std::sin(a[0] * kDegree);
    case Function::kCos: return std::cos(a[0] * kDegree);
    case Function::kTan: return std::tan(a[0] * kDegree);
    case Function::kAsin: return std::asin(a[0]) / kDegree;
    case Function::kAcos: return std::acos(a[0]) / kDegree;
    case Function::kAtan: return std::atan(a[0]) / kDegree;
    case Function::kAtan2: return std::atan2(a[0], a[1]) / kDegree;
    case Function::kExp: return std::exp(a[0]);
    case Function::kLog: return std::log(a[0]);
    case Function::kSqrt: return std::sqrt(a[0]);
    case Function::kFloor: return std::floor(a[0]);
    case Function::kCeil: return std::ceil(a[0]);
    case Function::kTrunc: return std::trunc(a[0]);
    case Function::kFabs: return std::fabs(a[0]);
    case Function::kSign: return a[0] > 0 ? 1 : a[0] < 0 ? -1 : 0;
    case Function::kMin: return a[0] < a[1] ? a[0] : a[1];
    case Function::kMax: return a[0] > a[1] ? a[0] : a[1];
    case Function::kPow: return std::pow(a[0], a[1]);
    case Function::kRan: return random_.uniform() * a[0];
    case Function::kNran: return a[0] + a[1] * random_.normal();
    case Function::kBran: return a[0] > 0 && a[1] > 0 ? random_.beta(a[0], a[1]) : std::nan("");
    case Function::kBiran:
      return a[0] >= 0 && a[0] <= 1e6 && a[1] >= 0 && a[1] <= 1 ? random_.binomial(a[0], a[1]) : std::nan("");
    case Function::kFunc: {
      const double number = std::trunc(a[0]);
      if (!(number >= 1 && number <= static_cast<double>(tables_.curves.size()))) return std::nan("");
      return tables_.curves[static_cast<std::size_t>(number) - 1].value(a[1]);
    }
    case Function::kSrand:
      random_.reseed(static_cast<std::uint64_t>(std::fmin(std::fabs(a[0]), 9e15)));
      return 0;
  }
  return std::nan("");
}

double& Machine::element(const ArrayInfo& array, const double* indices, const Place& place) {
  std::size_t flat = 0;
  for (std::size_t d = 0; d < array.sizes.size(); ++d) {
    const double i = indices[d];
    if (!(i >= 0.0 && i < array.sizes[d]))
      throw InputError(located(tables_.files, place), "index " + number_text(i) + " of '" + array.name + "'",
                       "0 to " + std::to_string(array.sizes[d] - 1));
    flat = flat * array.sizes[d] + static_cast<std::size_t>(i);
  }
  return globals_[array.first + flat];
}

void Machine::print(const PrintCall& call, const double* values) {
  if (printer_ && *printer_) (*printer_)(printf_text(call.format, values, call.values));
}

const double* Machine::run(const Code& code, double* locals) {
  if (stack_.size() < code.stack_size + 1) stack_.resize(code.stack_size + 1);
  double* top = stack_.data() - 1;  // the topmost value
  const std::size_t count = code.instructions.size();
  std::uint64_t budget = kMaxWork;
  std::size_t pc = 0;
  const auto fail = [&](std::string found, std::string expected) {
    throw InputError(located(tables_.files, code.places[pc]), std::move(found), std::move(expected));
  };
  while (pc < count) {
    if (--budget == 0) fail("a loop that does not end", "fewer than 4000000 operations for one module");
    const CodeInstruction in = code.instructions[pc];
    switch (in.op) {
      case Opcode::kConstant: *++top = code.constants[in.operand]; break;
      case Opcode::kLocal: *++top = locals[in.operand]; break;
      case Opcode::kGlobal: *++top = globals_[in.operand]; break;
      case Opcode::kStoreLocal: locals[in.operand] = *top--; break;
      case Opcode::kStoreGlobal: globals_[in.operand] = *top--; break;
      case Opcode::kDrop: --top; break;
      case Opcode::kNegate: *top = -*top; break;
      case Opcode::kNot: *top = *top == 0.0; break;
      case Opcode::kTruth: *top = *top != 0.0; break;
      case Opcode::kAdd: --top; top[0] += top[1]; break;
      case Opcode::kSubtract: --top; top[0] -= top[1]; break;
      case Opcode::kMultiply: --top; top[0] *= top[1]; break;
      case Opcode::kDivide:
        --top;
        if (top[1] == 0.0) fail("a division by zero", "a divisor other than 0");
        top[0] /= top[1];
        break;
      case Opcode::kModulo:
        --top;
        if (top[1] == 0.0) fail("a remainder of a division by zero", "a divisor other than 0");
        top[0] = std::fmod(top[0], top[1]);
        break;
      case Opcode::kPower: --top; top[0] = std::pow(top[0], top[1]); break;
      case Opcode::kLess: --top; top[0] = top[0] < top[1]; break;
      case Opcode::kLessEqual: --top; top[0] = top[0] <= top[1]; break;
      case Opcode::kGreater: --top; top[0] = top[0] > top[1]; break;
      case Opcode::kGreaterEqual: --top; top[0] = top[0] >= top[1]; break;
      case Opcode::kEqual: --top; top[0] = top[0] == top[1]; break;
      case Opcode::kNotEqual: --top; top[0] = top[0] != top[1]; break;
      case Opcode::kAndJump:
        if (*top == 0.0) {
          pc = in.operand;
          continue;
        }
        --top;
        break;
      case Opcode::kOrJump:
        if (*top != 0.0) {
          *top = 1.0;
          pc = in.operand;
          continue;
        }
        --top;
        break;
      case Opcode::kJump: pc = in.operand; continue;
      case Opcode::kJumpIfZero:
        if (*top-- == 0.0) {
          pc = in.operand;
          continue;
        }
        break;
      case Opcode::kCall: {
        const auto function = static_cast<Function>(in.operand & 0xff);
        const std::uint32_t arity = in.operand >> 8;
        double* arguments = top + 1 - arity;
        const double result = call(function, arguments);
        if (!std::isfinite(result)) {
          std::string values;
          for (std::uint32_t i = 0; i < arity; ++i) {
            if (i > 0) values += ',';
            values += number_text(arguments[i]);
          }
          fail(std::string(name_of(function)) + "(" + values + ")", "arguments for which it is a finite number");
        }
        top = arguments;
        *top = result;
        break;
      }
      case Opcode::kElement: {
        const ArrayInfo& array = tables_.arrays[in.operand];
        top -= array.sizes.size() - 1;
        *top = element(array, top, code.places[pc]);
        break;
      }
      case Opcode::kStoreElement: {
        const ArrayInfo& array = tables_.arrays[in.operand];
        const double value = *top--;
        top -= array.sizes.size() - 1;
        element(array, top, code.places[pc]) = value;
        --top;
        break;
      }
      case Opcode::kPrint:
        top -= code.prints[in.operand].values;
        print(code.prints[in.operand], top + 1);
        *++top = 0.0;
        break;
    }
    if (in.op >= Opcode::kAdd && in.op <= Opcode::kPower && !std::isfinite(*top))
      fail("a number that is not finite", "an expression within the range of a double");
    ++pc;
  }
  work += kMaxWork - budget;
  return stack_.data();
}

double constant_value(const Code& code, const CodeTables& tables) {
  CounterRandom random(0);
  std::vector<double> no_variables;
  return Machine(tables, random, no_variables).value(code, nullptr);
}

}  // namespace cambium
