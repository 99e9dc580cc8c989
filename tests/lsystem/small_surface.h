// A surface file for tests: a flat square of side 2 across z = 1, held in the middle of its lower edge.
#pragma once

#include <string>

namespace cambium::test {

inline std::string surface_header(const std::string& contact = "X: 0 Y: -1 Z: 1",
                                  const std::string& heading = "X: 0 Y: 2 Z: 0", const std::string& up = "X: 0 Y: 1 Z: 1",
                                  const std::string& size = "4") {
  return "-1.00 1.00   -1.00 1.00   1.00 1.00\nCONTACT POINT  " + contact +
         "\nEND POINT  X: 0.00 Y: 1.00 Z: 1.00\nHEADING  " + heading + "\nUP  " + up + "\nSIZE: " + size + "\n";
}

inline std::string surface_patch(
    const std::string& points =
        "-1 1 1  -0.3333333333 1 1  0.3333333333 1 1  1 1 1\n"
        "-1 0.3333333333 1  -0.3333333333 0.3333333333 1  0.3333333333 0.3333333333 1  1 0.3333333333 1\n"
        "-1 -0.3333333333 1  -0.3333333333 -0.3333333333 1  0.3333333333 -0.3333333333 1  1 -0.3333333333 1\n"
        "-1 -1 1  -0.3333333333 -1 1  0.3333333333 -1 1  1 -1 1\n") {
  return "patch\nTOP COLOR: 0 DIFFUSE: 0.00 BOTTOM COLOR: 0 DIFFUSE: 0.00\nAL: ~ A: ~ AR: ~ \nL: ~ R: ~ \nBL: ~ B: ~ BR: ~ "
         "\n" +
         points;
}

}  // namespace cambium::test
