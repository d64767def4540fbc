#include "duoptic/spelling.h"

#include <algorithm>

namespace duo {
namespace {

/// Letters to change, with a change of places as one.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

std::string bare(const std::string& word) { return word.substr(std::min(word.find_first_not_of('-'), word.size())); }

}  // namespace

std::string likeliest(const std::string& word, const std::vector<std::string>& names) {
  const std::string meant = bare(word);
  std::string best;
  double least = 1;
  for (const std::string& name : names) {
    const std::string known = bare(name);
    const std::size_t letters = std::min(meant.size(), known.size()), off = distance(meant, known);
    const auto alike = std::mismatch(meant.begin(), meant.begin() + static_cast<std::ptrdiff_t>(letters), known.begin());
    const auto begin = static_cast<std::size_t>(alike.first - meant.begin());
    const bool inside =
        letters >= 3 && (known.find("-" + meant) != std::string::npos || meant.find("-" + known) != std::string::npos);
    const double by_letters = static_cast<double>(off) / (1.5 + static_cast<double>(letters) / 3);
    const double by_parts = letters >= 2 && begin == letters ? 0.4 : inside ? 0.6 : begin >= 3 ? 0.8 : 1.0;
    const double badness = std::min(by_letters, by_parts + 0.001 * static_cast<double>(off));
    if (badness < least) best = name, least = badness;
  }
  return best;
}

}  // namespace duo
