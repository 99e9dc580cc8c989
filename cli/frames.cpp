#include "cli/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "cli/output_file.h"
#include "cli/units.h"
#include "lsystem/growth.h"
#include "raytrace/framing.h"

namespace cambium {
namespace {

constexpr double kMostFrames = 9999;
constexpr double kSameTime = 1e-9;  // as a whole step, or as the end

struct Frame {
  int number = 0;   // from 1
  double time = 0;  // derivation steps
};

void check_request(const Job& job) {
  const double step = *job.line.growth_step;
  if (!(step > 0) || !std::isfinite(step))
    throw InputError({"--step"}, fmt::format("{}", step), "a number of derivation steps above 0");
  if (job.source_kind != InputKind::kLSystem)
    throw InputError({job.source.string()}, "no L-system",
                     "an L-system (.l .lpy) or a recipe with one: --step is of what grows");
  if (job.line.turntable) throw InputError({"--turntable"}, "a turntable beside --step", "one of them");
  if (job.line.close_up || job.recipe.render.close_up)
    throw InputError(job.line.close_up ? SourceLocation{"--close-up"} : job.recipe.render.close_up->at,
                     "a close-up beside --step", "no branch: branches are numbered anew in every frame");
}

std::vector<Frame> frames_of(const CommandLine& line, int steps) {
  const double count = std::floor(steps / *line.growth_step + kSameTime) + 1;
  if (count > kMostFrames) throw InputError({"--step"}, fmt::format("{:.0f} frames", count), "at most 9999: a larger step");
  if (line.frame && *line.frame > count)
    throw InputError({"--frame"}, fmt::format("frame {}", *line.frame), fmt::format("1 to {:.0f}", count));
  std::vector<Frame> frames;
  for (int number = line.frame.value_or(1); number <= line.frame.value_or(static_cast<int>(count)); ++number) {
    const double time = (number - 1) * *line.growth_step, whole = std::round(time);
    frames.push_back({number, std::abs(time - whole) < kSameTime ? whole : std::min<double>(time, steps)});
  }
  return frames;
}

/// The plant at each time, for one L-system.
class GrowingPlant {
 public:
  explicit GrowingPlant(Job& job)
      : job_(job), system_(load_lsystem(job)), options_(derive_options(job)), growth_(system_, options_, job.run) {}

  int steps() const { return growth_.steps(); }

  /// nullopt if interrupted.
  std::optional<Plant> at(double time) {
    const StageTimer timer(job_.figures, "grow");
    const auto grown = growth_.at(time);
    if (!grown) return std::nullopt;
    auto turtled = interpret(*grown, system_, options_.turtle, job_.run);
    job_.progress.clear();
    if (!turtled) return std::nullopt;
    return Plant{std::move(turtled->skeleton), std::move(turtled->foliage)};
  }

 private:
  Job& job_;
  const LSystem system_;
  const DeriveOptions options_;
  Growth growth_;
};

/// Of every internode, and of every organ if they are drawn.
std::vector<Box> boxes_of(const Plant& plant, bool leaves) {
  std::vector<Box> boxes;
  const std::vector<SkeletonNode>& nodes = plant.skeleton.nodes;
  for (const SkeletonNode& node : nodes) {
    Box box{node.position, node.position};
    if (node.parent >= 0) box.extend(nodes[static_cast<std::size_t>(node.parent)].position);
    boxes.push_back(box.padded(node.radius));
  }
  if (!leaves) return boxes;
  for (const OrganPlacement& organ : plant.foliage.organs) {
    double reach = 0;
    for (const Vec3& vertex : plant.foliage.shapes[organ.shape].vertices) reach = std::max(reach, glm::length(vertex));
    boxes.push_back(Box{organ.position, organ.position}.padded(reach * organ.scale));
  }
  return boxes;
}

/// What all pictures share: the camera's place, and where the ground is.
struct Stage {
  Vec3 eye{0.0}, target{0.0};
  double ground = 0;
};

/// For a plant with wood in pictures of the job's size.
Stage stage_for(const Plant& plant, const Job& job) {
  const RenderRecipe& render = job.recipe.render;
  auto [width, height] = std::pair(render.width, render.height);
  if (!job.line.size.empty()) std::tie(width, height) = parse_image_size(job.line.size, {"--size"});
  const std::vector<Box> boxes = boxes_of(plant, job.recipe.leaves);
  const View view = frame(render.camera, boxes, width, height);
  Box whole;
  for (const Box& box : boxes) whole.extend(box);
  const double distance = std::max(glm::dot(whole.center() - view.eye, view.forward), glm::length(whole.size()) * 1e-3);
  Stage stage{view.eye, view.eye + distance * view.forward, kInfinity};
  for (const SkeletonNode& node : plant.skeleton.nodes) stage.ground = std::min(stage.ground, node.position.z);
  return stage;
}

void set_stage(const Stage& stage, RenderRecipe& render) {
  render.camera.eye = stage.eye;
  render.camera.target = stage.target;
  if (!render.light.ground_height) render.light.ground_height = stage.ground;
}

/// One frame: the command as if it were called for it alone, with what has grown in place of the input's own tree.
Outcome make_frame(Job& job, const Frame& frame, Plant plant, const std::optional<Stage>& stage, Outcome (*command)(Job&),
                   Json& made) {
  CommandLine line = job.line;
  line.growth_step.reset();
  line.frame.reset();
  line.output = numbered_path(job.line.output, frame.number).string();
  Job one(line, *job.run.cancel);
  if (stage) set_stage(*stage, one.recipe.render);
  const std::size_t nodes = plant.skeleton.nodes.size();
  one.grown = std::move(plant);
  const Outcome outcome = command(one);
  one.progress.clear();
  for (const std::string& warning : one.warnings) job.warnings.push_back(fmt::format("{}: {}", line.output, warning));
  const Json seconds_by_stage = one.figures.object()["seconds"];
  for (const auto& [name, seconds] : seconds_by_stage.items())
    if (name != "total") job.figures.add_seconds(name, seconds.get<double>());
  if (outcome == Outcome::kDone) made.push_back({{"time", frame.time}, {"nodes", nodes}, {"output", line.output}});
  return outcome;
}

}  // namespace

Outcome run_frames(Job& job, Outcome (*command)(Job&)) {
  check_request(job);
  GrowingPlant growing(job);
  const std::vector<Frame> frames = frames_of(job.line, growing.steps());
  const OutputFile probe(numbered_path(job.line.output, frames.front().number));  // so that a bad path fails now
  std::optional<Stage> stage;
  if (job.line.command == Command::kRender) {
    const auto last = growing.at(growing.steps());
    if (!last) return Outcome::kInterrupted;
    if (!last->skeleton.nodes.empty()) stage = stage_for(*last, job);
  }
  Json made = Json::array();
  std::size_t left_out = 0;
  for (const Frame& frame : frames) {
    auto plant = growing.at(frame.time);
    if (!plant) return Outcome::kInterrupted;
    if (plant->skeleton.nodes.empty() && job.line.command != Command::kGrow) {
      ++left_out;
      continue;
    }
    if (make_frame(job, frame, std::move(*plant), stage, command, made) == Outcome::kInterrupted)
      return Outcome::kInterrupted;
  }
  if (made.empty()) throw InputError({job.source.string()}, "no wood at any of the times", "an L-system that draws");
  if (left_out > 0) job.warnings.push_back(fmt::format("frames without a file, since nothing has grown yet: {}", left_out));
  job.figures.set("frames", made);
  return Outcome::kDone;
}

}  // namespace cambium
