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

void write_mesh(const Mesh& mesh, const std::filesystem::path& path, const std::string& format, UpAxis up) {
  std::string extension = format;
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const bool known = extension == ".obj" || extension == ".ply" || extension == ".stl" || extension == ".off" ||
                     extension == ".glb";
  if (!known) {
    throw InputError({path.string(), 0, 0}, format.empty() ? "a file name without an extension" : "extension " + format,
                     ".obj, .ply, .stl, .off or .glb");
  }
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
    written = extension == ".glb" ? write_glb(mesh, out) : write_with_openmesh(mesh, out, extension.substr(1), up);
  } catch (const std::exception& error) {
    fail(error.what());
  }
  out.flush();
  if (!out) fail(system_reason());
  if (!written) fail("the writer for " + extension + " refused it");
}

}  // namespace cambium
