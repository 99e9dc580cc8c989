#include "lsystem/lpy_symbols.h"

#include <iterator>
#include <string_view>

namespace cambium {
namespace {

struct KnownName {
  std::string_view name;
  std::string_view same_as;  // empty: it has no other name
};

// L-Py's help card.
constexpr KnownName kKnown[] = {
    {"SB", "["}, {"EB", "]"}, {"Pinpoint", ""}, {"PinpointRel", ""}, {"@R", ""}, {"SetHead", "@R"}, {"EulerAngles", ""},
    {"Left", "+"}, {"Right", "-"}, {"Up", "^"}, {"Down", "&"}, {"RollL", "/"}, {"RollR", "\\"}, {"iRollL", ""},
    {"iRollR", ""}, {"TurnAround", "|"}, {"@v", ""}, {"RollToVert", "@v"}, {"LeftReflection", ""}, {"UpReflection", ""},
    {"HeadingReflection", ""}, {"@M", ""}, {"MoveTo", "@M"}, {"MoveRel", ""}, {"@2D", ""}, {"StartScreenProjection", "@2D"},
    {"@3D", ""}, {"EndScreenProjection", "@3D"}, {"@Dd", ""}, {"DivScale", "@Dd"}, {"@Di", ""}, {"MultScale", "@Di"},
    {"@D", ""}, {"SetScale", "@D"}, {"nF", ""}, {"@Gc", ""}, {"StartGC", "@Gc"}, {"@Ge", ""}, {"EndGC", "@Ge"}, {"BP", "{"},
    {"EP", "}"}, {"PP", "."}, {"LineTo", ""}, {"OLineTo", ""}, {"LineRel", ""}, {"OLineRel", ""}, {"@O", ""},
    {"Sphere", "@O"},
    {"@B", ""}, {"Box", "@B"}, {"@b", ""}, {"Quad", "@b"}, {"@o", ""}, {"Circle", "@o"}, {"@L", ""}, {"Label", "@L"},
    {"surface", ""}, {"@g", ""}, {"PglShape", "@g"}, {"Frame", ""}, {"SetContour", ""}, {"SectionResolution", ""},
    {"SetGuide", ""}, {"EndGuide", ""}, {"Sweep", ""}, {"PositionOnGuide", ""}, {"IncWidth", "_"}, {"DecWidth", "!"},
    {"SetWidth", ""}, {"IncColor", ";"}, {"DecColor", ","}, {"SetColor", ""}, {"InterpolateColors", ""}, {"@Ts", ""},
    {"Elasticity", "@Ts"}, {"@Tp", ""}, {"Tropism", "@Tp"}, {"?P", ""}, {"GetPos", "?P"}, {"?H", ""}, {"GetHead", "?H"},
    {"?U", ""}, {"GetUp", "?U"}, {"?L", ""}, {"GetLeft", "?L"}, {"?R", ""}, {"GetRight", "?R"}, {"?F", ""},
    {"GetFrame", "?F"},
    {"TextureScale", ""}, {"TextureUScale", ""}, {"TextureVScale", ""}, {"TextureVCoeff", "TextureVScale"},
    {"TextureTranslation", ""}, {"TextureRotation", ""}, {"TextureTransformation", ""}, {"Cut", "%"}};

constexpr std::string_view kMarks = "+-&^\\/|[]{}.!;,'%~_";

}  // namespace

std::string LpySymbols::read(Cursor& in) const {
  const KnownName* known = nullptr;
  for (const KnownName& candidate : kKnown)
    if (in.looking_at(candidate.name) && (!known || candidate.name.size() > known->name.size())) known = &candidate;
  std::string_view longest = known ? known->name : std::string_view();
  std::string name(known && !known->same_as.empty() ? known->same_as : longest);
  for (const std::string& candidate : declared_) {
    if (candidate.size() < longest.size() || !in.looking_at(candidate)) continue;
    longest = candidate;
    name = candidate;
  }
  if (!longest.empty()) {
    in.advance(longest.size());
    return name;
  }
  const char c = in.peek();
  if (c == '@' || c == '?') in.fail("one of the names that L-Py gives its turtle's commands");
  const bool surface = c == '~' && starts_word(in.peek(1));
  if (in.at_end() || (!starts_word(c) && kMarks.find(c) == kMarks.npos)) return {};
  name = surface ? std::string{c, in.peek(1)} : std::string(1, c);
  in.advance(name.size());
  return name;
}

}  // namespace cambium
