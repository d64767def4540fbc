// The matchers that there are: a new one adds its include and its name, and its include to matchers_vk.h.
#pragma once

#include "matchers/fine/fine.h"
#include "matchers/matcher_list.h"
#include "matchers/pyramid/pyramid.h"
#include "matchers/sgm/sgm.h"

namespace duo {

using Matchers = MatcherList<SgmMatcher, PyramidMatcher, FineMatcher>;

}  // namespace duo
