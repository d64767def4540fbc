// What a matcher needs to know before the first pair.
#pragma once

#include "duoptic/image.h"

namespace duo {

struct MatchSetup {
  Size size;
  int max_disparity = 0;  // searches [0, max_disparity)
  bool masked = false;    // pairs come with inside pictures
};

}  // namespace duo
