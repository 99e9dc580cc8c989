#include "polygonize/mesh_io.h"

#include "blobtree/input_error.h"
#include "polygonize/mesh_formats.h"

#include <cctype>
#include <cerrno>
#include <cstring>
#include <exception>
#include <fstream>
#include <stdexcept>

namespace cambium {
namespace {

bool write(const MeshFile& file, std::ostream& out, const std::string& extension, UpAxis up) {
  if (extension == ".glb") return write_glb(file, out);
  const MeshLevel& level = file.levels.front();
  if (extension == ".obj") return write_obj(level, file.leaves, out, up);
  if (extension == ".ply") return write_ply(level, out, up);
  return write_with_openmesh(level, out, extension.substr(1), up);
}

}  // namespace

bool holds_leaves(std::string_view format) { return format == ".glb" || format == ".obj"; }

std::string image_type(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return "image/png";
  return bytes.starts_with("\xff\xd8\xff") ? "image/jpeg" : "";
}

void write_mesh(const MeshFile& file, const std::filesystem::path& path, const std::string& format, UpAxis up) {
  std::string extension = format;
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const bool known = extension == ".obj" || extension == ".ply" || extension == ".stl" || extension == ".off" ||
                     extension == ".glb";
  if (!known) {
    throw InputError({path.string(), 0, 0}, format.empty() ? "a file name without an extension" : "extension " + format,
                     ".obj, .ply, .stl, .off or .glb");
  }
  if (file.levels.empty()) throw InputError({path.string(), 0, 0}, "no level of detail", "at least one");
  if (file.levels.size() > 1 && extension != ".glb")
    throw InputError({path.string(), 0, 0}, std::to_string(file.levels.size()) + " levels of detail in one " + extension,
                     "one level, or .glb");
  const auto require_known_image = [&](const MeshMaterial& material) {
    if (material.texture && image_type(*material.texture).empty())
      throw InputError({path.string(), 0, 0}, "a texture of " + material.name + " in another format", "PNG or JPEG");
  };
  for (const MeshMaterial& material : file.materials) require_known_image(material);
  for (const MeshLeaves& leaves : file.leaves) require_known_image(leaves.material);
  errno = 0;
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  const auto fail = [&](const std::string& reason) {
    out.close();
    throw std::runtime_error(path.string() + ": cannot write the mesh: " + reason);
  };
  const auto system_reason = [] { return errno ? std::string(std::strerror(errno)) : std::string("output error"); };
  if (!out) fail(system_reason());
  bool written = false;
  try {
    written = write(file, out, extension, up);
  } catch (const std::exception& error) {
    fail(error.what());
  }
  out.flush();
  if (!out) fail(system_reason());
  if (!written) fail("the writer for " + extension + " refused it");
}

void write_mesh(const Mesh& mesh, const std::filesystem::path& path, const std::string& format, UpAxis up) {
  write_mesh(MeshFile{{{&mesh, nullptr, 0}}, {}, {}}, path, format, up);
}

}  // namespace cambium
