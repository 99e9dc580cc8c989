// eval, volume: what the field is at points and voxels.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "cli/commands.h"
#include "cli/output_file.h"
#include "cli/points_csv.h"
#include "cli/units.h"
#include "polygonize/volume.h"

namespace cambium {
namespace {

/// nullopt if interrupted.
std::optional<std::vector<Sample>> sample_field(const Field& field, const std::vector<Vec3>& points, const RunOptions& run) {
  std::vector<Sample> samples(points.size());
  tbb::task_arena arena(run.threads > 0 ? run.threads : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 64), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end() && !run.cancelled(); ++i) samples[i] = field.sample(points[i]);
    });
  });
  if (run.cancelled()) return std::nullopt;
  return samples;
}

VolumeOptions volume_options(const Job& job) {
  VolumeOptions options = job.recipe.volume;
  const CommandLine& line = job.line;
  if (!line.voxel.empty()) options.voxel = parse_positive_length(line.voxel, {"--voxel"});
  if (line.kind == "sdf")
    options.kind = VolumeKind::kSdf;
  else if (line.kind == "field")
    options.kind = VolumeKind::kField;
  else if (line.kind == "fog")
    options.kind = VolumeKind::kFog;
  else if (!line.kind.empty())
    throw InputError({"--kind"}, "'" + line.kind + "'", "sdf, field or fog");
  return options;
}

}  // namespace

Outcome run_eval(Job& job) {
  OutputFile output(job.line.output);
  const std::vector<Vec3> points = read_points(job.line.points);
  const auto field = build_field(job);
  if (!field) return Outcome::kInterrupted;
  std::optional<std::vector<Sample>> samples;
  {
    const StageTimer timer(job.figures, "evaluate");
    samples = sample_field(*field, points, job.run);
  }
  if (!samples) return Outcome::kInterrupted;
  const StageTimer timer(job.figures, "write");
  write_text(output.temporary(), samples_as_csv(points, *samples));
  job.figures.set("points", points.size());
  if (job.run.cancelled()) return Outcome::kInterrupted;
  output.commit();
  return Outcome::kDone;
}

Outcome run_volume(Job& job) {
  require_extension(job.line.output, {".vdb"});
  const VolumeOptions options = volume_options(job);
  OutputFile output(job.line.output);
  const auto field = build_field(job);
  if (!field) return Outcome::kInterrupted;
  std::optional<VolumeReport> report;
  {
    const StageTimer timer(job.figures, "volume");
    report = write_volume(*field, options, output.temporary(), job.run);
  }
  if (!report || job.run.cancelled()) return Outcome::kInterrupted;
  job.figures.set("active_voxels", report->active_voxels);
  job.figures.set("voxel", report->voxel);
  output.commit();
  return Outcome::kDone;
}

}  // namespace cambium
