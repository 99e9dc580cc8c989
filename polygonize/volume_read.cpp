#include "polygonize/volume_read.h"

#include "blobtree/input_error.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/Interpolation.h>

#include <cmath>
#include <stdexcept>

namespace cambium {
namespace {

using Grid = openvdb::FloatGrid;

std::string text_of(const openvdb::Vec3d& p) {
  return "(" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + ", " + std::to_string(p.z()) + ")";
}

Grid::Ptr read_grid(const std::filesystem::path& path, const std::string& name) {
  openvdb::initialize();   // more than once does nothing
  openvdb::io::File file(path.string());
  file.open(false);   // all of it is read now
  for (auto at = file.beginName(); at != file.endName(); ++at) {
    if (!name.empty() && *at != name) continue;
    if (const auto grid = openvdb::gridPtrCast<Grid>(file.readGrid(*at))) return grid;
    if (!name.empty()) throw InputError({path.string()}, "the grid '" + name + "' of another kind", "a grid of floats");
  }
  throw InputError({path.string()}, "no grid of floats" + (name.empty() ? "" : " named '" + name + "'"), "a grid of floats");
}

/// Nothing outside of what was painted: what most tools write there.
void take_zero_for_one(Grid& grid) {
  if (grid.background() == 0) openvdb::tools::changeBackground(grid.tree(), 1.0f);
}

void require_factors(const Grid& grid, const std::filesystem::path& path) {
  const auto refuse = [&](float value, const std::string& where) {
    throw InputError({path.string()}, "the value " + std::to_string(value) + " " + where, "a factor, finite and above 0, everywhere");
  };
  const auto sound = [](float value) { return value > 0 && std::isfinite(value); };
  if (!sound(grid.background())) refuse(grid.background(), "outside the grid (its background)");
  for (auto at = grid.cbeginValueAll(); at; ++at)
    if (!sound(*at)) refuse(*at, "at " + text_of(grid.indexToWorld(at.getCoord())));
}

}  // namespace

std::function<double(const Vec3&)> read_factor_volume(const std::filesystem::path& path, const std::string& name) {
  Grid::ConstPtr grid;
  try {
    const Grid::Ptr read = read_grid(path, name);
    take_zero_for_one(*read);
    grid = read;
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw std::runtime_error(path.string() + ": cannot read the volume: " + error.what());
  }
  require_factors(*grid, path);
  return [grid](const Vec3& p) {
    const Grid::ConstUnsafeAccessor values = grid->getConstUnsafeAccessor();   // of this call alone; the grid does not change
    return static_cast<double>(openvdb::tools::BoxSampler::sample(values, grid->worldToIndex(openvdb::Vec3d(p.x, p.y, p.z))));
  };
}

}  // namespace cambium
