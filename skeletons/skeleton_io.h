// Skeleton files: .skel.json and .swc in and out, QSM .csv in (formats.md).
#pragma once

#include "skeletons/foliage.h"
#include "skeletons/skeleton.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace cambium {

/// All that a plant's file may hold.
struct Plant {
  Skeleton skeleton;
  Foliage foliage;
};

/// As read_skeleton. Only a .skel.json may have foliage.
Plant read_plant(const std::filesystem::path& path);

/// By extension. Nodes come in file order where parents already stand first there, else depth first.
/// Errors: InputError naming file, line and column.
Skeleton read_skeleton(const std::filesystem::path& path);

/// The same from text; `file` is only named in messages.
/// .skel.json: optional node keys base_radius and lateral; unknown keys are errors. Optional beside "nodes" are "shapes", each with
/// name, vertices and triangles of a leaf, and "organs", each with shape, node (-1: none), position, left, heading, up, scale and an
/// optional color: see foliage.h.
Plant parse_plant_json(std::string_view text, const std::string& file);
Skeleton parse_skel_json(std::string_view text, const std::string& file);
/// SWC: seven columns `id type x y z radius parent`, # comments. Lengths are taken as metres.
Skeleton parse_swc(std::string_view text, const std::string& file);
/// Cylinder table, columns by name whatever their case (SimpleForest, TreeQSM, rTwig); separated by comma, semicolon or tab.
/// An internode per cylinder; small gaps are closed, a gap wider than the radius becomes an internode of its own.
Skeleton parse_qsm_csv(std::string_view text, const std::string& file);

/// format is "skel.json" or "swc" (a leading dot is allowed). Every number reads back as the same double; SWC leaves out
/// base_radius, lateral and the foliage.
std::string skeleton_text(const Skeleton& skeleton, const std::string& format, const Foliage& foliage = {});

/// Writes exactly that path. Errors: std::runtime_error naming the path (unwritable, disk full), std::invalid_argument for
/// an unknown format. A failed write may leave a partial file behind: write beside and rename.
void write_skeleton(const Skeleton& skeleton, const std::filesystem::path& path, const std::string& format,
                    const Foliage& foliage = {});

}  // namespace cambium
