// The sections of the benchmark. Each measures, and adds its rows to the report.
#pragma once

#include "bench/measurements.h"
#include "bench/report.h"

namespace cambium::bench {

/// Sums of cones and chains in one cell against the yardstick; every other primitive and operator.
void batch_section(Report& report, const Pace& pace);
void node_section(Report& report, const Pace& pace);
/// Points, intervals, pruning and batches in cells on the poplar of examples/.
void poplar_section(Report& report, const Pace& pace);
/// Building, memory, pruning and covers over the size and shape of generated trees.
void trees_section(Report& report, const Pace& pace);
/// Derivation of strings of ten million modules.
void lsystem_section(Report& report, const Pace& pace);
/// Graphs of up to ten million nodes, and whole plans. Takes most of a minute.
void graphs_section(Report& report, const Pace& pace);
/// Our mesher against OpenVDB's at equal error. Takes minutes, and some gigabytes for OpenVDB's.
void mesher_section(Report& report, const Pace& pace);
/// Rays at the field against Embree's own curves. Takes half a minute.
void rays_section(Report& report, const Pace& pace);

}  // namespace cambium::bench
