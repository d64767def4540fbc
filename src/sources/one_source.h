// One source whose pictures hold both views, as one stream of pairs.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "duoptic/source.h"

namespace duo {

/// The size of one picture that holds two views of `view` px; side by side when not said.
Size size_of_both(Size view, std::optional<ViewLayout> layout);

/// Halves of each picture, as `layout` has them. Without one they lie side by side, and the first pictures with enough texture
/// have to show the same, else next() fails: one camera's picture makes no pair.
///
/// Errors  the side that is halved is odd
Result<std::unique_ptr<PairSource>> halve(std::unique_ptr<Source> both, const std::string& name,
                                          std::optional<ViewLayout> layout);

}  // namespace duo
