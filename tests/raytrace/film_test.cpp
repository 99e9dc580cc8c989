#include "raytrace/film.h"

#include "blobtree/input_error.h"
#include "raytrace/image_file.h"
#include "raytrace/tone.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace cambium {
namespace {

class FilmFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("cambium_film_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    film_.width = 3;
    film_.height = 2;
    for (int i = 0; i < 6; ++i) {
      film_.color.insert(film_.color.end(), {0.1f * i, 0.2f, 5.0f, 1.0f});
      film_.depth.push_back(i == 5 ? INFINITY : 1.0f + i);
      film_.normal.insert(film_.normal.end(), {0, 0, 1});
      film_.albedo.insert(film_.albedo.end(), {0.25f, 0.5f, 0.75f});
      film_.branch.push_back(i == 5 ? -1.0f : 7.0f);
    }
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
  Film film_;
};

TEST_F(FilmFiles, PngIsToneMappedEightBitWhateverTheFileIsCalled) {
  const auto path = folder_ / "still.tmp123";
  write_image(film_, path, ".png", {});
  std::ifstream file(path, std::ios::binary);
  char magic[4] = {};
  file.read(magic, 4);
  EXPECT_EQ(std::string(magic + 1, 3), "PNG");
  std::filesystem::rename(path, folder_ / "still.png");
  const Pixels pixels = read_pixels(folder_ / "still.png");
  ASSERT_EQ(pixels.width, 3);
  ASSERT_EQ(pixels.height, 2);
  ASSERT_EQ(pixels.channels, 3);
  EXPECT_TRUE(pixels.srgb);
  EXPECT_NEAR(pixels.data[3 * 4], display_from_linear({0.4, 0.2, 5.0}).x, 0.5 / 255 + 1e-6);
}

TEST_F(FilmFiles, ExrIsLinearFloatWithTheAskedAovs) {
  const auto path = folder_ / "still.part";
  write_image(film_, path, ".exr", {"depth", "normal", "albedo", "branch"});
  std::filesystem::rename(path, folder_ / "still.exr");
  const Pixels pixels = read_pixels(folder_ / "still.exr");
  EXPECT_EQ(pixels.channels, 4);  // the reader keeps the first four
  EXPECT_FALSE(pixels.srgb);
  EXPECT_FLOAT_EQ(pixels.data[2], 5.0f);
  std::ifstream file(folder_ / "still.exr", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  for (const char* name : {"depth.Z", "normal.X", "albedo.B", "branch.id"}) EXPECT_NE(bytes.find(name), std::string::npos) << name;
}

TEST_F(FilmFiles, AovPicturesAreWrittenOneByOne) {
  for (const char* name : {"depth", "normal", "albedo", "branch"}) write_aov(film_, folder_ / (std::string(name) + ".png"), name);
  EXPECT_NEAR(read_pixels(folder_ / "normal.png").data[2], 1.0, 1e-6);
  EXPECT_NEAR(read_pixels(folder_ / "depth.png").data[0], 1.0, 1e-6);
  EXPECT_NEAR(read_pixels(folder_ / "depth.png").data[3 * 5], 0.0, 1e-6);
  EXPECT_NEAR(read_pixels(folder_ / "albedo.png").data[0], srgb_from_linear(0.25), 0.5 / 255 + 1e-6);
  EXPECT_EQ(read_pixels(folder_ / "branch.png").data[3 * 5], 0.0f);
}

TEST_F(FilmFiles, UnknownFormatsAndAovsAreTheUsersError) {
  EXPECT_THROW(write_image(film_, folder_ / "a.jpg", ".jpg", {}), InputError);
  EXPECT_THROW(write_image(film_, folder_ / "a.exr", ".exr", {"colour"}), InputError);
  EXPECT_THROW(write_aov(film_, folder_ / "a.png", "colour"), InputError);
  film_.depth.clear();
  EXPECT_THROW(write_image(film_, folder_ / "a.exr", ".exr", {"depth"}), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(FilmFiles, AnUnwritablePathIsNamedAndLeavesNothing) {
  for (const char* format : {".png", ".exr"}) {
    const auto path = folder_ / "missing" / "still";
    try {
      write_image(film_, path, format, {});
      FAIL() << format;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
    }
    EXPECT_FALSE(std::filesystem::exists(path));
  }
}

TEST_F(FilmFiles, AnImageThatIsNoneIsTheUsersErrorNamingTheFile) {
  std::ofstream(folder_ / "bark.png") << "not an image";
  for (const char* name : {"bark.png", "absent.png"}) {
    try {
      read_pixels(folder_ / name);
      FAIL() << name;
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().file, (folder_ / name).string());
    }
  }
}

}  // namespace
}  // namespace cambium
