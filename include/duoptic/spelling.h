// The word that was meant by one that is not known.
#pragma once

#include <string>
#include <vector>

namespace [[gnu::visibility("default")]] duo {

/// The likeliest of `names`: few letters are missing, too many, other ones, or have changed places with a neighbour, or one word
/// is part of the other. Dashes in front do not count. Empty: none is like it.
///
/// Source  Damerau, "A technique for computer detection and correction of spelling errors", 1964
std::string likeliest(const std::string& word, const std::vector<std::string>& names);

}  // namespace duo
