// The files of one rendered picture.
#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <vector>

#include "cli/figures.h"
#include "cli/output_file.h"
#include "raytrace/film.h"

namespace cambium {

/// The picture itself, and beside a PNG or JPEG its auxiliary images: tree.png has tree.depth.png.
class PictureFiles {
 public:
  /// Errors: those of OutputFile.
  PictureFiles(const std::filesystem::path& path, const ImageFormat& format, const std::set<Aov>& aovs);

  const std::filesystem::path& path() const { return path_; }
  void write(const Film& film);
  void commit();
  /// The names of the images beside it by what they show; empty for an EXR.
  Json names_beside() const;

 private:
  struct Beside {
    Aov aov;
    std::filesystem::path path;
    std::unique_ptr<OutputFile> file;
  };

  ImageFormat format_;
  std::filesystem::path path_;
  OutputFile image_;
  std::vector<Beside> beside_;
};

}  // namespace cambium
