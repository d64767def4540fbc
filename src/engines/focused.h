// Matching of a part of a pair, between some disparities alone.
#pragma once

#include <list>
#include <variant>

#include "core/check.h"
#include "duoptic/engine.h"
#include "duoptic/frame.h"
#include "engines/prepared.h"
#include "matchers/match.h"
#include "stages/types/gray_pair.h"

namespace duo {

/// What is matched for a focus, as a pair of its own: its right picture lies `first_disparity` px to the left of the left one.
/// Widths and disparities are whole vectors. Where few sizes are wanted, as memory is made for each, they are eighths of the
/// picture's width and quarters of its height.
///
/// Units  px of the left rectified picture
struct FocusPart {
  Window kept;     // what is wanted of it
  Window matched;  // inside the picture; what is seen at its left border may lie outside of it in the right one
  int first_disparity = 0, disparities = 0;
  int row_step = 1;
};

/// `focus` not empty inside the picture.
FocusPart focus_part(const Focus& focus, Size size, int max_disparity, bool few_sizes);

/// The part of a pair, whose disparity 0 is the part's first one; and where its matches go. Views.
/// `balanced`: the pair's right picture, as it is compared.
GrayPair part_of(const GrayPair& whole, View<const std::uint8_t> balanced, const FocusPart& part);
Match part_of(Frame& frame, const FocusPart& part);
/// What was matched becomes disparities of the whole pair where it is wanted, none elsewhere.
void keep_part(const FocusPart& part, Frame& frame);

/// Matchers that can measure a whole pair and then match a part of it, in the same memory or in memory of that size.
template <class M>
concept MatchesParts = requires(M& matcher, const GrayPair& pair, const Match& match, StageTimer& timer) {
  matcher.match_measured(pair, matcher.measure(pair, timer), 1, 1, match, timer);
};
template <class M>
concept MatchesItsSize = requires(M& matcher, const GrayPair& pair, const Match& match, StageTimer& timer) {
  matcher.match_measured(pair, matcher.measure(pair, timer), match, timer);
};

/// What parts of pairs are matched in.
template <class Matcher>
class Focused {
 public:
  /// `of_whole`: the matcher of whole pairs, which measures them. make(setup, matcher): a matcher for these, where `of_whole`
  /// is one of its own size alone: then a part of a new size allocates.
  template <class Make>
  void match(const Prepared& prepared, const Focus& focus, const GrayPair& whole, Matcher& of_whole, Make make,
             StageTimer& timer, Frame& frame) {
    const auto match_part = [&]<class M>(M& matcher) {
      DUO_CHECK(MatchesParts<M> || MatchesItsSize<M>);  // as Engine::can_focus() says
      if constexpr (MatchesParts<M> || MatchesItsSize<M>) {
        const FocusPart part = focus_part(focus, prepared.size, prepared.setup.max_disparity, !MatchesParts<M>);
        const Measured measured = matcher.measure(whole, timer);
        const GrayPair pair = part_of(whole, measured.right, part);
        if constexpr (MatchesParts<M>)
          matcher.match_measured(pair, measured, part.disparities, part.row_step, part_of(frame, part), timer);
        else
          std::get<M>(of_size(part, whole.masked(), make)).match_measured(pair, measured, part_of(frame, part), timer);
        keep_part(part, frame);
        timer.stage("cut");
      }
    };
    std::visit(match_part, *of_whole);
  }

 private:
  static constexpr std::size_t kMostSizes = 12;
  struct OfSize {
    Size size;
    int disparities = 0;
    Matcher matcher;
  };

  /// Matchers of sizes stay while these come again.
  template <class Make>
  auto& of_size(const FocusPart& part, bool masked, Make make) {
    const Size size{part.matched.width, part.matched.height};
    for (OfSize& each : sizes_)
      if (each.size == size && each.disparities == part.disparities) return *each.matcher;
    if (sizes_.size() == kMostSizes) sizes_.pop_front();
    OfSize& out = sizes_.emplace_back();
    out.size = size, out.disparities = part.disparities;
    make(MatchSetup{size, part.disparities, masked}, out.matcher);
    return *out.matcher;
  }

  std::list<OfSize> sizes_;
};

}  // namespace duo
