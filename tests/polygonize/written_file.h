// What write_mesh leaves on disk, read back whole.
#pragma once

#include "polygonize/mesh_io.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace cambium::testing {

inline std::string written(const MeshFile& file, const std::string& format, UpAxis up = UpAxis::kZ) {
  const auto* const test = ::testing::UnitTest::GetInstance()->current_test_info();
  const auto path = std::filesystem::temp_directory_path() /
                    ("cambium_" + std::string(test->test_suite_name()) + "_" + std::string(test->name()) + ".part");
  write_mesh(file, path, format, up);
  std::ifstream in(path, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(in)), {});
  in.close();
  std::filesystem::remove(path);
  return bytes;
}

inline std::string written(const Mesh& mesh, const std::string& format, UpAxis up = UpAxis::kZ) {
  return written(MeshFile{{{&mesh, nullptr, 0}}, {}}, format, up);
}

template <class T>
T read_at(const std::string& bytes, std::size_t at) {
  T value{};
  EXPECT_LE(at + sizeof(T), bytes.size());
  if (at + sizeof(T) <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

}  // namespace cambium::testing
