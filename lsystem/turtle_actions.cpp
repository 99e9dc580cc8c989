#include "lsystem/turtle_actions.h"

#include <unordered_map>

namespace cambium {

TurtleAction turtle_action(std::string_view symbol) {
  using enum TurtleAction;
  static const std::unordered_map<std::string_view, TurtleAction> kActions = {
      {"F", kDraw},        {"G", kDraw},       {"f", kMove},       {"g", kMove},
      {"@M", kPlace},      {"@R", kOrient},
      {"+", kYawLeft},     {"-", kYawRight},   {"&", kPitchDown},  {"^", kPitchUp},
      {"\\", kRollLeft},   {"/", kRollRight},  {"|", kTurnBack},   {"$", kLevel},     {"@v", kLevel},
      {"@Ts", kElasticity}, {"@T", kElasticity}, {"@Td", kTropism},
      {"!", kThinner},     {"#", kThicker},
      {"[", kOpen},        {"]", kClose},      {"%", kCut},        {"?", kCall},
      {"{", kPolygonOpen}, {"}", kPolygonClose}, {".", kSilent},
      {"?P", kAskPosition}, {"?H", kAskHeading}, {"?U", kAskUp},   {"?L", kAskLeft}};
  const auto found = kActions.find(symbol);
  return found == kActions.end() ? kSkip : found->second;
}

}  // namespace cambium
