#include "cli/points_csv.h"

#include <gtest/gtest.h>

#include "blobtree/input_error.h"
#include "temporary_folder.h"

namespace cambium {
namespace {

std::vector<Vec3> read(std::string_view text) {
  TemporaryFolder folder;
  return read_points(folder.write("p.csv", text));
}

TEST(PointsCsv, RowsAreReadWithAndWithoutHeader) {
  const std::vector<Vec3> expected = {{1, 2, 3}, {-0.5, 0, 1e3}};
  EXPECT_EQ(read("x,y,z\n1,2,3\n-0.5,0,1e3\n"), expected);
  EXPECT_EQ(read("1, 2 ,3\r\n\r\n-0.5,0,1e3"), expected);
  EXPECT_TRUE(read("").empty());
  EXPECT_TRUE(read("X, Y, Z\n").empty());
}

TEST(PointsCsv, MalformedRowsAreRefusedAtTheirPlace) {
  struct Malformed {
    const char* text;
    int line, column;
  };
  for (const auto& [text, line, column] :
       {Malformed{"1,2\n", 1, 4}, Malformed{"1,2,3,4\n", 1, 7}, Malformed{"1,2,3\n1,nan,3\n", 2, 3},
        Malformed{"1,,3\n", 1, 3}, Malformed{"x,y\n1,2,3\n", 1, 1}, Malformed{"1,2,3\nx,y,z\n", 2, 1},
        Malformed{"1,2,inf", 1, 5}, Malformed{"1;2;3", 1, 1}}) {
    SCOPED_TRACE(text);
    try {
      read(text);
      ADD_FAILURE() << "was accepted";
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().line, line);
      EXPECT_EQ(error.location().column, column);
    }
  }
}

TEST(PointsCsv, SamplesAreWrittenWithNineDigits) {
  EXPECT_EQ(samples_as_csv({{1, 2, 1.0 / 3}}, {{0.5, {0, -1e-9, 12345678.25}}}),
            "x,y,z,f,gx,gy,gz\n1,2,0.333333333,0.5,0,-1e-09,12345678.2\n");
}

}  // namespace
}  // namespace cambium
