// The smallest inputs of every kind: a stem with one branch.
#pragma once

namespace cambium {

inline constexpr const char* kTinyLSystem =
    "lsystem: tiny\nderivation length: 2\naxiom: !(0.2)A\nA --> F(1)[+(50)!(0.1)F(0.6)]A\nendlsystem\n";

inline constexpr const char* kTinySkeleton =
    R"({"format":"cambium-skeleton","version":1,"nodes":[
{"position":[0,0,0],"radius":0.1,"parent":-1},
{"position":[0,0,1],"radius":0.1,"parent":0},
{"position":[0,0,2],"radius":0.08,"parent":1},
{"position":[0.5,0,1.6],"radius":0.05,"parent":1}]})";

inline constexpr const char* kTinySwc =
    "# a stem\n1 1 0 0 0 0.1 -1\n2 1 0 0 1 0.1 1\n3 1 0 0 2 0.08 2\n4 1 0.5 0 1.6 0.05 2\n";

inline constexpr const char* kTinyCsv =
    "startX,startY,startZ,endX,endY,endZ,radius,ID,parentID\n0,0,0,0,0,1,0.1,0,-1\n0,0,1,0,0,2,0.08,1,0\n0,0,1,0.5,0,1.6,0."
    "05,2,0\n";

inline constexpr const char* kTinyBlobTree =
    R"({"format":"cambium-blobtree","version":1,"root":{"op":"sphere","center":[0,0,1],"radius":0.5}})";

inline constexpr const char* kTinyRecipe =
    "[skeleton]\nlsystem = \"tiny.l\"\n[surface]\nlip = 1\n[render]\nsize = \"24x32\"\nsamples = 1\n[mesh]\nvoxel = "
    "\"4cm\"\n"
    "[volume]\nvoxel = \"4cm\"\n";

}  // namespace cambium
