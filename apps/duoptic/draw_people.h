// What a detector saw, over its picture.
#pragma once

#include <span>

#include "duoptic/detector.h"

namespace duo::app {

/// Bones, points and boxes; the left side warm, the right one cold, pale what is probably hidden, hands with a colour a finger.
void draw_people(std::span<const SeenPerson> people, View<Rgb8> picture);

}  // namespace duo::app
