// What each symbol of a string means to the turtle.
#pragma once

#include <string_view>

namespace cambium {

enum class TurtleAction {
  kSkip,
  kDraw, kMove,            ///< F, f: each ends in a corner of the outline around it, if there is one
  kDrawBetween, kMoveBetween,  ///< G, g: the same without a corner
  kPlace, kOrient,
  kYawLeft, kYawRight, kPitchDown, kPitchUp, kRollLeft, kRollRight, kTurnBack, kLevel,
  kElasticity, kStiffer, kTropismOrSofter,
  kThinner, kThicker, kNextColor, kLastColor,
  kOpen, kClose, kCut, kCall,
  kBraceOpen, kBraceClose, kCorner, kSurface, kSphere, kDisc,
  kAxisStart, kAxisPoint, kAxisEnd, kAxisTangents, kContour,
  kAskPosition, kAskHeading, kAskUp, kAskLeft
};

/// kSkip: a symbol that the turtle does not know.
TurtleAction turtle_action(std::string_view symbol);

}  // namespace cambium
