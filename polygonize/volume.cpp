#include "polygonize/volume.h"

#include "blobtree/input_error.h"
#include "polygonize/lattice.h"
#include "polygonize/narrow_band.h"
#include "polygonize/volume_samples.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/FastSweeping.h>
#include <openvdb/tools/LevelSetUtil.h>
#include <openvdb/tools/Prune.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

namespace cambium {
namespace {

using Grid = openvdb::FloatGrid;
using Leaf = Grid::TreeType::LeafNodeType;

void tell(const RunOptions& run, const char* stage, double fraction) {
  if (run.progress) run.progress(stage, fraction);
}

// The blocks are given back one by one as leaves take their place.
Grid::Ptr field_grid(std::vector<std::unique_ptr<FieldBlock>> blocks) {
  Grid::Ptr grid = Grid::create(0.0f);
  for (auto& block : blocks) {
    const openvdb::Coord first(block->first[0], block->first[1], block->first[2]);
    Leaf* leaf = nullptr;
    for (int i = 0; i < 512; ++i) {
      if (!(block->values[i] > 0)) continue;
      if (!leaf) leaf = grid->tree().touchLeaf(first);
      leaf->setValueOn(static_cast<openvdb::Index>(i), block->values[i]);   // both count z fastest
    }
    block.reset();
  }
  grid->setName("field");
  grid->setGridClass(openvdb::GRID_UNKNOWN);
  return grid;
}

// Cuts the band to its width: OpenVDB's dilation goes by whole voxels, diagonals included.
void trim_band(Grid& grid, float width) {
  openvdb::tree::LeafManager<Grid::TreeType> leaves(grid.tree());
  leaves.foreach([width](Leaf& leaf, std::size_t) {
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
      const float value = leaf.getValue(i);
      if (leaf.isValueOn(i) && std::abs(value) < width) continue;
      leaf.setValueOff(i, std::copysign(width, value));
    }
  });
  grid.tree().root().setBackground(width, false);
  openvdb::tools::signedFloodFillWithValues(grid.tree(), width, width);
  openvdb::tools::pruneLevelSet(grid.tree());
}

// Wider bands than are measured go on from there by fast sweeping.
Grid::Ptr level_set(const Field& field, const VolumeOptions& options, const RunOptions& run) {
  const double measured = std::min(options.half_width, kMostBandVoxels);
  auto leaves = narrow_band(field, options.voxel, measured, run);
  if (!leaves) return nullptr;
  const float band = static_cast<float>((leaves->empty() ? options.half_width : measured) * options.voxel);
  Grid::Ptr grid = Grid::create(band);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(options.voxel));
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  grid->setName("surface");
  for (auto& from : *leaves) {
    auto* leaf = new Leaf(openvdb::Coord(from->first[0], from->first[1], from->first[2]), band, false);
    for (int i = 0; i < 512; ++i) {
      const auto at = static_cast<openvdb::Index>(i);
      leaf->setValueOnly(at, from->distances[i]);
      if (from->active[i]) leaf->setActiveState(at, true);
    }
    grid->tree().addLeaf(leaf);
    from.reset();
  }
  if (run.cancelled()) return nullptr;
  if (leaves->empty()) return grid;
  // Leaves know all their signs; what lies between them takes theirs.
  openvdb::tools::signedFloodFillWithValues(grid->tree(), band, band, true, 1, 1);
  if (options.half_width > measured) {
    tell(run, "widening the band", 0);
    const int more = static_cast<int>(std::ceil(options.half_width - measured));
    grid = openvdb::tools::dilateSdf(*grid, more, openvdb::tools::NN_FACE_EDGE_VERTEX, 1);
    if (run.cancelled()) return nullptr;
    trim_band(*grid, static_cast<float>(options.half_width * options.voxel));
    grid->setName("surface");
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    tell(run, "widening the band", 1);
  }
  return grid;
}

Grid::Ptr make_grid(const Field& field, const VolumeOptions& options, const RunOptions& run) {
  if (options.kind == VolumeKind::kField) {
    auto blocks = sample_field(field, options.voxel, run);
    return blocks ? field_grid(std::move(*blocks)) : nullptr;
  }
  Grid::Ptr grid = level_set(field, options, run);
  if (!grid || options.kind == VolumeKind::kSdf) return grid;
  openvdb::tools::sdfToFogVolume(*grid);
  grid->setName("density");
  return grid;
}

/// OpenVDB gives every file a random identifier, 36 characters after a header of 21 bytes. Ours is drawn from the content, so that
/// the same volume is the same file.
void name_by_content(const std::filesystem::path& path) {
  constexpr std::streamoff kBegin = 21, kLength = 36;
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekg(kBegin + kLength);
  std::uint64_t hash[2] = {0xcbf29ce484222325u, 0x84222325cbf29ce4u};
  std::vector<char> block(1 << 16);
  while (file.read(block.data(), static_cast<std::streamsize>(block.size())), file.gcount() > 0)
    for (std::streamsize i = 0; i < file.gcount(); ++i)
      for (std::uint64_t& h : hash) h = (h ^ static_cast<unsigned char>(block[static_cast<std::size_t>(i)])) * 0x100000001b3u;
  std::string id = fmt::format("{:016x}{:016x}", hash[0], hash[1]);
  for (const std::size_t at : {8u, 13u, 18u, 23u}) id.insert(at, "-");
  file.clear();
  file.seekp(kBegin);
  file.write(id.data(), kLength);
  if (!file.flush()) throw std::runtime_error("the file's identifier could not be written");
}

void write_grid(Grid::Ptr grid, const std::filesystem::path& path) {
  openvdb::io::File file(path.string());
  file.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK | openvdb::io::COMPRESS_BLOSC);
  file.write(openvdb::GridPtrVec{grid});
  file.close();
  name_by_content(path);
}

}  // namespace

std::optional<VolumeReport> write_volume(const Field& field, const VolumeOptions& options, const std::filesystem::path& path,
                                         const RunOptions& run) {
  require_length(options.voxel, "voxel");
  if (!(options.half_width >= 1 && options.half_width <= 100)) {
    throw InputError({}, "a half width of " + std::to_string(options.half_width) + " voxels", "1 to 100 voxels");
  }
  static std::once_flag initialized;
  std::call_once(initialized, [] { openvdb::initialize(); });
  std::optional<tbb::global_control> threads;   // OpenVDB's own loops
  if (run.threads > 0) threads.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(run.threads));

  const Grid::Ptr grid = make_grid(field, options, run);
  if (!grid || run.cancelled()) return std::nullopt;
  grid->setTransform(openvdb::math::Transform::createLinearTransform(options.voxel));
  grid->setSaveFloatAsHalf(false);
  grid->setCreator("Cambium");
  VolumeReport report{grid->activeVoxelCount(), options.voxel};
  std::error_code ignored;
  try {
    tell(run, "writing", 0);
    write_grid(grid, path);
  } catch (const std::exception& error) {
    std::filesystem::remove(path, ignored);
    throw std::runtime_error(path.string() + ": cannot write the volume: " + error.what());
  }
  if (run.cancelled()) {
    std::filesystem::remove(path, ignored);
    return std::nullopt;
  }
  tell(run, "writing", 1);
  return report;
}

}  // namespace cambium
