#include "cli/picture_files.h"

#include "raytrace/image_file.h"

namespace cambium {

PictureFiles::PictureFiles(const std::filesystem::path& path, const ImageFormat& format, const std::set<Aov>& aovs)
    : format_(format), path_(path), image_(path) {
  require_image_files();
  if (format.extension == ".exr") return;
  for (const Aov aov : aovs) {
    std::filesystem::path beside = path;
    beside.replace_extension(std::string(".") + info_of(aov).name + ".png");
    beside_.push_back({aov, beside, std::make_unique<OutputFile>(beside)});
  }
}

void PictureFiles::write(const Film& film) {
  write_image(film, image_.temporary(), format_);
  for (const Beside& aov : beside_) write_aov(film, aov.file->temporary(), aov.aov);
}

void PictureFiles::commit() {
  for (const Beside& aov : beside_) aov.file->commit();
  image_.commit();
}

Json PictureFiles::names_beside() const {
  Json names = Json::object();
  for (const Beside& aov : beside_) names[info_of(aov.aov).name] = aov.path.string();
  return names;
}

}  // namespace cambium
