// Points of a scene that both cameras see: what a rig can be judged and put right by without a board.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/lens.h"
#include "duoptic/source.h"

namespace duo {

/// One point in both raw pictures.
struct SceneMatch {
  Vec2 left_px, right_px;
  double weight = 1;  // of its row: a point's, known to a few hundredths of a pixel, over what this one is known to
};

struct SceneMatches {
  Size size;
  int pairs = 0;     // that were looked at
  bool cut = false;  // the stream was cut short; its whole pairs were used
  std::vector<SceneMatch> matches;
  int fewest_points = 0;  // that a picture has, matched or not
  int share_pixels = 0;   // of patches: so many have each pixel, and count as one; 0: points
};

/// How much time a pair may take.
enum class SceneSearch : std::uint8_t {
  kThorough,
  kQuick,  // points are looked for in pictures of at most 480 columns, and fewer of them are laid over each other
};

/// Finds and matches the points of one pair after the other, in memory that it keeps.
class SceneMatcher {
 public:
  SceneMatcher(Size size, int threads, SceneSearch search = SceneSearch::kThorough);
  ~SceneMatcher();
  void add(const Pair& pair);
  /// Another pair of the same cameras in the same place: the matches of the last add() are laid over each other anew, and no
  /// other is looked for. That takes a third of the time, and their noise is another.
  void add_same(const Pair& pair);
  /// Of all pairs so far.
  SceneMatches matches() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

inline constexpr std::int64_t kTwoMinutes = 3600;  // pairs of a usual camera

/// SIFT points of pairs spread evenly over a stream, matched by their descriptors alone: no place, row or rig is assumed, so
/// that some matches are wrong. Pictures of fewer than 240 columns are doubled first, of more than 2560 halved. Where one part
/// of the picture has far more of them than others, the best of its own are kept.
///
/// `farthest`: pairs that are read at most; a live source gives a tenth of them
/// Errors      those of the stream
Result<SceneMatches> match_scene(PairSource& pairs, int threads, std::int64_t farthest = kTwoMinutes);

/// The same of one pair.
SceneMatches match_pair(const Pair& pair, int threads, SceneSearch search = SceneSearch::kThorough);

/// The cell of a picture parted into columns and rows that a place lies in, row by row.
int cell_of(Vec2 at_px, Size size, int columns, int rows);

/// Which thirds of the left picture have no points, in words; empty when all have some.
std::string missing_parts(const std::vector<SceneMatch>& matches, Size size);

/// How much of the left picture has points, 0 .. 1, in cells of an eighth by a sixth.
double covered_share(const std::vector<SceneMatch>& matches, Size size);

}  // namespace duo
