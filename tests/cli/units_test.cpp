#include "cli/units.h"

#include <gtest/gtest.h>

namespace cambium {
namespace {

const SourceLocation kHere{"--voxel"};

TEST(Units, LengthsTakeMillimetresCentimetresAndMetres) {
  EXPECT_DOUBLE_EQ(parse_length("5mm", kHere), 0.005);
  EXPECT_DOUBLE_EQ(parse_length("0.5 cm", kHere), 0.005);
  EXPECT_DOUBLE_EQ(parse_length(" 2 m ", kHere), 2);
  EXPECT_DOUBLE_EQ(parse_length("-1e-3", kHere), -0.001);
  EXPECT_DOUBLE_EQ(parse_length("+3", kHere), 3);
}

TEST(Units, WhatIsNoLengthIsRefusedByName) {
  for (const char* text : {"", "mm", "5 miles", "nan", "inf", "1e999", "5mm5", "--5", "0x5", "5,2"}) {
    SCOPED_TRACE(text);
    try {
      parse_length(text, kHere);
      FAIL();
    } catch (const InputError& error) {
      EXPECT_EQ(error.location().file, "--voxel");
      EXPECT_EQ(error.found(), "'" + std::string(text) + "'");
    }
  }
}

TEST(Units, PartsOfPiNameIt) {
  EXPECT_DOUBLE_EQ(parse_parts_of_pi("0.3pi").value(), 0.3);
  EXPECT_DOUBLE_EQ(parse_parts_of_pi(" -0.12 pi ").value(), -0.12);
  EXPECT_DOUBLE_EQ(parse_parts_of_pi("pi").value(), 1);
  EXPECT_DOUBLE_EQ(parse_parts_of_pi("-pi").value(), -1);
  for (const char* text : {"", "0.3", "0.3pix", "pipi", "--1pi", "nan pi", "p", "0.3 deg"}) EXPECT_FALSE(parse_parts_of_pi(text)) << text;
}

TEST(Units, PositiveLengthsRefuseZeroAndLess) {
  EXPECT_THROW(parse_positive_length("0mm", kHere), InputError);
  EXPECT_THROW(parse_positive_length("-2mm", kHere), InputError);
  EXPECT_DOUBLE_EQ(parse_positive_length("2mm", kHere), 0.002);
}

TEST(Units, CountsTakeThousandsAndMillions) {
  EXPECT_EQ(parse_count("20000", kHere), 20000u);
  EXPECT_EQ(parse_count("50k", kHere), 50000u);
  EXPECT_EQ(parse_count(" 1.2M ", kHere), 1200000u);
  for (const char* text : {"", "k", "0", "0k", "-5k", "5K", "5m", "1.5", "0.0001k", "5kk", "nan", "inf", "1e300", "5 k"}) {
    SCOPED_TRACE(text);
    EXPECT_THROW(parse_count(text, kHere), InputError);
  }
}

TEST(Units, ImageSizesAreTwoWholeSides) {
  EXPECT_EQ(parse_image_size("768x1024", kHere), std::pair(768, 1024));
  EXPECT_EQ(parse_image_size("1X65536", kHere), std::pair(1, 65536));
  for (const char* text : {"0x0", "10", "10x", "x10", "10x0", "-1x5", "10x65537", "10x20x30", "1.5x2", "99999999999x1"}) {
    SCOPED_TRACE(text);
    EXPECT_THROW(parse_image_size(text, kHere), InputError);
  }
}

TEST(Units, NumbersAreFiniteAndWhole) {
  EXPECT_DOUBLE_EQ(parse_number(" 2.5e-1\t", kHere), 0.25);
  for (const char* text : {"", "x", "nan", "-inf", "1 2"}) EXPECT_THROW(parse_number(text, kHere), InputError) << text;
}

TEST(Units, SamplesAreTheMostOrARange) {
  EXPECT_EQ(parse_samples("16", kHere), (std::pair<std::optional<int>, int>{std::nullopt, 16}));
  EXPECT_EQ(parse_samples(" 1..16 ", kHere), (std::pair<std::optional<int>, int>{1, 16}));
  EXPECT_EQ(parse_samples("4..4", kHere), (std::pair<std::optional<int>, int>{4, 4}));
  for (const char* text : {"", "0", "65536", "16..1", "1..", "..1", "1.5", "1 .. 2x"}) {
    SCOPED_TRACE(text);
    EXPECT_THROW(parse_samples(text, kHere), InputError);
  }
}

TEST(Units, CropsAreFourWholeNumbers) {
  EXPECT_EQ(parse_crop("0, 1,20,30", kHere), (PixelRect{0, 1, 20, 30}));
  for (const char* text : {"", "1,2,3", "1,2,3,4,5", "1,2,3,", "1,2,3,x", "1,2,3,-4", "1,2,3,65537"}) {
    SCOPED_TRACE(text);
    EXPECT_THROW(parse_crop(text, kHere), InputError);
  }
}

}  // namespace
}  // namespace cambium
