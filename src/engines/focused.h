// Matching of a part of a pair, between some disparities alone.
#pragma once

#include <list>
#include <variant>

#include "core/check.h"
#include "duoptic/engine.h"
#include "duoptic/frame.h"
#include "engines/prepared.h"
#include "stages/types/gray_pair.h"

namespace duo {

/// What is matched for a focus. Sizes have few values, so that memory that was made for one serves again: eighths of the
/// picture's width, quarters of its height, and whole vectors of disparities.
///
/// Units  px of the left rectified picture
struct FocusPart {
  Window kept;     // what is wanted of it
  Window matched;  // inside the picture; what is seen at its left border may lie outside of it in the right one
  int first_disparity = 0, disparities = 0;
};

/// `focus` not empty inside the picture.
FocusPart focus_part(const Focus& focus, Size size, int max_disparity);

/// A part of a pair as a pair of its own: disparity 0 is the part's first one.
struct FocusMaps {
  FocusMaps(Size size, bool confidence);
  Image<std::uint8_t> left, right, left_inside, right_inside, confidence;
  Image<std::uint16_t> d_q4;

  /// Columns left of the right picture are its first one, and not inside.
  /// `balanced`: the frame's right picture, as it is compared.
  void cut(const FocusPart& part, const Frame& frame, View<const std::uint8_t> balanced);
  /// Disparity and confidence of the window that is kept, which becomes what was matched; none elsewhere.
  void put(const FocusPart& part, Frame& frame) const;
};

/// Matchers that can measure a whole pair and then match a part of it.
template <class M>
concept MatchesParts = requires(M& matcher, const GrayPair& pair, const Match& match, StageTimer& timer) {
  matcher.match_measured(pair, matcher.measure(pair, timer), match, timer);
};

/// Matchers and maps for parts of several sizes, which stay while their sizes come again.
template <class Matcher>
class Focused {
 public:
  /// `of_whole`: the matcher of whole pairs, which measures them. make(setup, matcher): a matcher for these. Allocates when a
  /// part of a new size comes.
  template <class Make>
  void match(const Prepared& prepared, const Focus& focus, const GrayPair& whole, Matcher& of_whole, Make make,
             StageTimer& timer, Frame& frame) {
    const FocusPart part = focus_part(focus, prepared.size, prepared.setup.max_disparity);
    OfSize& at = find(prepared, part, make);
    const auto match_part = [&]<class M>(M& matcher) {
      DUO_CHECK(MatchesParts<M>);  // as Engine::can_focus() says
      if constexpr (MatchesParts<M>) {
        const Measured measured = matcher.measure(whole, timer);
        at.maps.cut(part, frame, measured.right);
        timer.stage("cut");
        const GrayPair pair{at.maps.left, at.maps.right, at.maps.left_inside, at.maps.right_inside};
        std::get<M>(*at.matcher).match_measured(pair, measured, {at.maps.d_q4, at.maps.confidence}, timer);
      }
    };
    std::visit(match_part, *of_whole);
    at.maps.put(part, frame);
    timer.stage("cut");
  }

 private:
  static constexpr std::size_t kMostSizes = 12;
  struct OfSize {
    OfSize(Size size, bool confidence) : maps(size, confidence) {}
    int disparities = 0;
    FocusMaps maps;
    Matcher matcher;
  };

  template <class Make>
  OfSize& find(const Prepared& prepared, const FocusPart& part, Make make) {
    const Size size{part.matched.width, part.matched.height};
    for (OfSize& each : sizes_)
      if (each.maps.left.size() == size && each.disparities == part.disparities) return each;
    if (sizes_.size() == kMostSizes) sizes_.pop_front();
    OfSize& out = sizes_.emplace_back(size, prepared.setup.wants.confidence);
    out.disparities = part.disparities;
    make(MatchSetup{size, part.disparities, true}, out.matcher);
    return out;
  }

  std::list<OfSize> sizes_;
};

}  // namespace duo
