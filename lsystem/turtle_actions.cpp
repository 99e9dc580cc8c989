#include "lsystem/turtle_actions.h"

#include <unordered_map>

namespace cambium {

TurtleAction turtle_action(std::string_view symbol) {
  using enum TurtleAction;
  static const std::unordered_map<std::string_view, TurtleAction> kActions = {
      {"F", kDraw},        {"G", kDrawBetween}, {"f", kMove},      {"g", kMoveBetween},
      {"@M", kPlace},      {"@R", kOrient},
      {"+", kYawLeft},     {"-", kYawRight},   {"&", kPitchDown},  {"^", kPitchUp},
      {"\\", kRollLeft},   {"/", kRollRight},  {"|", kTurnBack},   {"$", kLevel},     {"@v", kLevel},
      {"@Ts", kElasticity}, {"@T", kElasticity}, {"@Ti", kStiffer}, {"@Td", kTropismOrSofter},
      {"!", kThinner},     {"#", kThicker},    {";", kNextColor},  {"'", kNextColor}, {",", kLastColor},
      {"[", kOpen},        {"]", kClose},      {"%", kCut},        {"?", kCall},
      {"{", kBraceOpen},   {"}", kBraceClose}, {".", kCorner},     {"@O", kSphere},    {"@o", kDisc}, {"@c", kDisc},
      {"@Gs", kAxisStart}, {"@Gc", kAxisPoint}, {"@Ge", kAxisEnd}, {"@Gt", kAxisTangents},
      {"@#", kContour},
      {"?P", kAskPosition}, {"?H", kAskHeading}, {"?U", kAskUp},   {"?L", kAskLeft}};
  if (symbol.starts_with('~')) return kSurface;
  const auto found = kActions.find(symbol);
  return found == kActions.end() ? kSkip : found->second;
}

}  // namespace cambium
