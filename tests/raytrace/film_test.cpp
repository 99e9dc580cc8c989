#include "raytrace/film.h"

#include "blobtree/input_error.h"
#include "raytrace/cryptomatte.h"
#include "raytrace/image_file.h"
#include "raytrace/tone.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

namespace cambium {
namespace {

/// A file as OpenImageIO sees it.
struct Opened {
  OIIO::ImageSpec spec;
  std::vector<float> values;

  explicit Opened(const std::filesystem::path& path) {
    const auto input = OIIO::ImageInput::open(path.string());
    if (!input) throw std::runtime_error(OIIO::geterror());
    spec = input->spec();
    values.resize(spec.image_pixels() * spec.nchannels);
    if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data())) throw std::runtime_error(input->geterror());
  }
  float value(int pixel, const std::string& channel) const {
    return values.at(std::size_t(pixel) * spec.nchannels + spec.channelindex(channel));
  }
  OIIO::TypeDesc type(const std::string& channel) const { return spec.channelformat(spec.channelindex(channel)); }
};

class FilmFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("cambium_film_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    film_.width = film_.full_width = 3;
    film_.height = film_.full_height = 2;
    for (int i = 0; i < 6; ++i) {
      film_.color.insert(film_.color.end(), {0.1f * float(i), 0.2f, 5.0f, 1.0f});
      for (const AovInfo& info : all_aovs()) {
        for (std::size_t c = 0; c < info.channels.size(); ++c) film_.aovs[info.aov].push_back(value(info.aov, i, c));
      }
    }
    film_.branches = {2, 7};
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// Something of its own for each pixel and channel; depth infinite and no branch in the last pixel.
  static float value(Aov aov, int pixel, std::size_t channel) {
    if (aov == Aov::kDepth) return pixel == 5 ? INFINITY : 1.0f + float(pixel);
    if (aov == Aov::kBranch) return pixel == 5 ? -1.0f : 16777213.0f;
    if (aov == Aov::kPosition) return 1000.001f * float(channel + 1) + float(pixel);
    if (aov == Aov::kCryptomatte) return 0.001f * float(24 * pixel) + float(channel);
    return 0.125f * float(channel + 1);
  }

  std::filesystem::path folder_;
  Film film_;
};

TEST_F(FilmFiles, PngIsToneMappedEightBitWhateverTheFileIsCalled) {
  const auto path = folder_ / "still.tmp123";
  write_image(film_, path, {".png"});
  std::filesystem::rename(path, folder_ / "still.png");
  const Pixels pixels = read_pixels(folder_ / "still.png");
  ASSERT_EQ(pixels.width, 3);
  ASSERT_EQ(pixels.height, 2);
  ASSERT_EQ(pixels.channels, 3);
  EXPECT_TRUE(pixels.srgb);
  EXPECT_NEAR(pixels.data[3 * 4], display_from_linear({0.4, 0.2, 5.0}).x, 0.5 / 255 + 1e-6);
}

TEST_F(FilmFiles, APngOfSixteenBitsIsFiner) {
  write_image(film_, folder_ / "still.png", {".png", 16});
  EXPECT_EQ(Opened(folder_ / "still.png").spec.format, OIIO::TypeDesc::UINT16);
  EXPECT_NEAR(read_pixels(folder_ / "still.png").data[3 * 4], display_from_linear({0.4, 0.2, 5.0}).x, 0.5 / 65535 + 1e-6);
}

TEST_F(FilmFiles, AJpegShowsWhatThePngDoesAndRefusesTransparency) {
  for (float& v : film_.color) v = 0.3f;   // even, so that little is lost
  write_image(film_, folder_ / "still.jpg", {".jpg"});
  write_image(film_, folder_ / "still.png", {".png"});
  const Pixels jpeg = read_pixels(folder_ / "still.jpg"), png = read_pixels(folder_ / "still.png");
  ASSERT_EQ(jpeg.data.size(), png.data.size());
  for (std::size_t i = 0; i < png.data.size(); ++i) EXPECT_NEAR(jpeg.data[i], png.data[i], 3.0 / 255);
  film_.transparent = true;
  EXPECT_THROW(write_image(film_, folder_ / "clear.jpg", {".jpg"}), InputError);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "clear.jpg"));
}

TEST_F(FilmFiles, ATransparentPngHasStraightAlphaAndAnExrPremultiplied) {
  film_.transparent = true;
  film_.color[4] = 0.1f, film_.color[5] = 0.05f, film_.color[6] = 0.2f, film_.color[7] = 0.5f;
  film_.color[0] = film_.color[1] = film_.color[2] = film_.color[3] = 0;
  write_image(film_, folder_ / "still.png", {".png"});
  write_image(film_, folder_ / "still.exr", {".exr"});
  const Pixels png = read_pixels(folder_ / "still.png");
  ASSERT_EQ(png.channels, 4);
  EXPECT_NEAR(png.data[4 + 3], 0.5, 0.5 / 255 + 1e-6);
  EXPECT_EQ(png.data[3], 0);
  std::ifstream file(folder_ / "still.png", std::ios::binary);
  const auto shown = display_from_linear({0.2, 0.1, 0.4});
  OIIO::ImageSpec as_it_is;
  as_it_is.attribute("oiio:UnassociatedAlpha", 1);
  const auto input = OIIO::ImageInput::open((folder_ / "still.png").string(), &as_it_is);
  std::vector<float> straight(6 * 4);
  ASSERT_TRUE(input->read_image(0, 0, 0, 4, OIIO::TypeDesc::FLOAT, straight.data()));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(straight[4 + c], shown[c], 0.5 / 255 + 1e-6);
  const Opened exr(folder_ / "still.exr");
  EXPECT_NEAR(exr.value(1, "R"), 0.1, 1e-4);
  EXPECT_EQ(exr.value(1, "A"), 0.5);
}

TEST_F(FilmFiles, ExrHasALayerForEveryAovWithItsValues) {
  const auto path = folder_ / "still.part";
  write_image(film_, path, {".exr"});
  std::filesystem::rename(path, folder_ / "still.exr");
  const Opened exr(folder_ / "still.exr");
  EXPECT_EQ(exr.value(4, "R"), static_cast<float>(static_cast<double>(exr.value(4, "R"))));
  EXPECT_NEAR(exr.value(4, "R"), 0.4, 2e-4);
  EXPECT_EQ(exr.value(0, "B"), 5.0f);
  EXPECT_EQ(exr.type("R"), OIIO::TypeDesc::HALF);
  std::size_t channels = 4;
  for (const AovInfo& info : all_aovs()) {
    for (std::size_t c = 0; c < info.channels.size(); ++c) {
      const std::string& name = info.channels[c];
      ASSERT_GE(exr.spec.channelindex(name), 0) << name;
      EXPECT_EQ(exr.type(name), info.full_float ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::HALF) << name;
      for (int i = 0; i < 6; ++i) EXPECT_EQ(exr.value(i, name), value(info.aov, i, c)) << name;
      ++channels;
    }
  }
  EXPECT_EQ(exr.spec.nchannels, static_cast<int>(channels));
  for (const auto& [name, text] : matte_metadata("CryptoBranch", film_.branches)) {
    EXPECT_EQ(exr.spec.get_string_attribute(name), text) << name;
  }
}

TEST_F(FilmFiles, ACropKeepsItsPlaceInTheExr) {
  film_.x = 7, film_.y = 9, film_.full_width = 20, film_.full_height = 30;
  write_image(film_, folder_ / "still.exr", {".exr"});
  const Opened exr(folder_ / "still.exr");
  EXPECT_EQ(exr.spec.x, 7);
  EXPECT_EQ(exr.spec.y, 9);
  EXPECT_EQ(exr.spec.full_width, 20);
  EXPECT_EQ(exr.spec.full_height, 30);
  EXPECT_EQ(exr.spec.width, 3);
}

TEST_F(FilmFiles, AovPicturesAreWrittenOneByOne) {
  film_.aovs[Aov::kNormal][2] = 1;
  film_.aovs[Aov::kAlbedo][0] = 0.25f;
  for (const AovInfo& info : all_aovs()) {
    const auto path = folder_ / (std::string(info.name) + ".png");
    write_aov(film_, path, info.aov);
    EXPECT_EQ(read_pixels(path).channels, 3) << info.name;
  }
  EXPECT_NEAR(read_pixels(folder_ / "normal.png").data[2], 1.0, 1e-6);
  EXPECT_NEAR(read_pixels(folder_ / "depth.png").data[0], 1.0, 1e-6);
  EXPECT_NEAR(read_pixels(folder_ / "depth.png").data[3 * 5], 0.0, 1e-6);
  EXPECT_NEAR(read_pixels(folder_ / "albedo.png").data[0], srgb_from_linear(0.25), 0.5 / 255 + 1e-6);
  EXPECT_EQ(read_pixels(folder_ / "branch.png").data[3 * 5], 0.0f);
}

TEST_F(FilmFiles, UnknownFormatsAndAbsentAovsAreTheUsersError) {
  EXPECT_THROW(write_image(film_, folder_ / "a.tif", {".tif"}), InputError);
  film_.aovs.erase(Aov::kDepth);
  EXPECT_THROW(film_.aov(Aov::kDepth), InputError);
  EXPECT_THROW(write_aov(film_, folder_ / "a.png", Aov::kDepth), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(FilmFiles, AnUnwritablePathIsNamedAndLeavesNothing) {
  for (const char* format : {".png", ".jpg", ".exr"}) {
    const auto path = folder_ / "missing" / "still";
    try {
      write_image(film_, path, {format});
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
