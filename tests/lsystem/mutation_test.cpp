// Broken files of every kind: whatever happens, it is an InputError.
#include "grammar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>

namespace cambium {
namespace {

std::string text_of(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::string mutated(std::string text, const std::vector<std::string>& seeds, std::mt19937& random) {
  static const std::string kPieces[] = {"(", ")", "[", "]", "{", "}", "-->", ":", "#define ", "#if ", "#endif\n", "\n", "*", "<",
                                        ">", "%", "0", "1e308", "-", "/", "^", "ran(", "\\\n", "/*", "\"", "A", "F(", ",", "\x7f",
                                        "lsystem:", "endlsystem", "axiom: ", "homomorphism\n", "decomposition\n", "@", "~", "=",
                                        "?(2)", "$", "ring lsystem\n", "do {", "while (", "? 1 :", "external ", "printf(\"%g\",", "* <"};
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % std::max<std::size_t>(n, 1)); };
  for (std::size_t edits = 1 + below(4); edits > 0; --edits) {
    const std::size_t at = below(text.size() + 1);
    switch (below(5)) {
      case 0: text.erase(at, 1 + below(20)); break;
      case 1: text.insert(at, kPieces[below(std::size(kPieces))]); break;
      case 2:
        if (at < text.size()) text[at] = static_cast<char>(random() & 0xff);
        break;
      case 3: {
        const std::string& other = seeds[below(seeds.size())];
        const std::size_t from = below(other.size());
        text.insert(at, other.substr(from, 1 + below(60)));
        break;
      }
      default: text.resize(at); break;
    }
  }
  return text;
}

TEST(Mutation, BrokenGrammarsOnlyEverThrowInputErrors) {
  const std::vector<std::string> seeds = {
      text_of(CAMBIUM_EXAMPLES "/lsystems/abop_2_6a.l"), text_of(CAMBIUM_EXAMPLES "/lsystems/abop_2_8d.l"),
      text_of(CAMBIUM_EXAMPLES "/poplar.l"),
      "#define M(a,b) ((a)+(b))\n#ifdef M\nlsystem: x\nseed: 3\nderivation length: 3\nignore: +-\n"
      "define: { array t[2,2] = {{1,2},{3,4}}; }\nStart: { g = 1; for (i = 0; i < 3; i = i + 1) g *= 2; }\n"
      "axiom: A(1)[B(2)]C\nA(x) < B(y) > C : {z = M(x,y);} z > 1 --> F(t[0][1])B(z) : 2\n"
      "A(x) --> A(x+ran(1))C : 1\nA(x) --> %A(x)[{.f.}] : 1\nB(y) --> @M(1,2,y)~l(y)@R(0,y,1)F\n"
      "decomposition\nmaximum depth: 3\nC : g > 4 --> !(0.1)F[-F]D\nhomomorphism\nD --> @O(1)F\nendlsystem\n#endif\n",
      "lsystem: 1\nring lsystem\nconsider: ABC[]\ndefine: { array a[2] = {1,2}; }\nStart: { n = 0; }\nEndEach: { n = n+1; }\n"
      "axiom: A(1)[B(2)=C]?(2,0.5)B(3)C$\nA(x)B(y) > [C=]B(z) : { do { n = n+1; x = x > 2 ? 0 : x+1; } while (x < 1); n - 1; } 1\n"
      "\t--> B(x)A(y)@L(\"%g\",n)\n* < B(y) > * --> C%B(a[1])\nendlsystem\n"
      "lsystem: 2\ndefine: { external n, a[2]; }\naxiom: B\nBC --> AA\nB(x) : n < 3 --> B(x)B(a[0]) : 2\nB(x) --> C : 1\n"
      "homomorphism: no warnings\nseed: 4\nmaximum depth: 3\nC --> F(1+ran(1))[C]\nendlsystem\n"};
  std::mt19937 random(20260101);
  std::size_t fine = 0, refused = 0;
  for (int round = 0; round < 6000; ++round) {
    const std::string text = mutated(seeds[random() % seeds.size()], seeds, random);
    try {
      const LSystem system = LSystem::parse(text, "mutated.l");
      DeriveOptions options;
      options.steps = 4;
      options.max_modules = 2000;
      TurtleOptions turtle;
      turtle.max_modules = 20000;
      interpret(derive(system, options, {}).value(), system, turtle, {});
      ++fine;
    } catch (const InputError& error) {
      ++refused;
      EXPECT_FALSE(error.found().empty());
      EXPECT_FALSE(error.expected().empty());
    }
    // Anything else that is thrown fails the test by itself.
  }
  // The mutations must reach both sides, or they test nothing.
  EXPECT_GT(fine, 300u);
  EXPECT_GT(refused, 1000u);
}

}  // namespace
}  // namespace cambium
