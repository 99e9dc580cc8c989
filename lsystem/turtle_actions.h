// What each symbol of a string means to the turtle.
#pragma once

#include <string_view>

namespace cambium {

enum class TurtleAction {
  kSkip, kSilent,
  kDraw, kMove, kPlace, kOrient,
  kYawLeft, kYawRight, kPitchDown, kPitchUp, kRollLeft, kRollRight, kTurnBack, kLevel,
  kElasticity, kTropism,
  kThinner, kThicker,
  kOpen, kClose, kCut, kCall,
  kPolygonOpen, kPolygonClose,
  kAskPosition, kAskHeading, kAskUp, kAskLeft
};

/// kSkip: a symbol that the turtle does not know.
TurtleAction turtle_action(std::string_view symbol);

}  // namespace cambium
