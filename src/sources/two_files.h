// Two files, or the two tracks of one, as one stream of pairs.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "sources/file_source.h"
#include "sources/recording.h"

namespace duo {

/// Both views as files, left first; their names for what is said of them.
struct TwoViews {
  std::array<std::unique_ptr<Source>, 2> sources;
  std::array<std::string, 2> names;
};

/// The n-th of both are a pair: two pictures, or the tracks of a recording of ours (`head`), whose pictures were paired when it
/// was made. A damaged picture of a recording takes its partner along.
std::unique_ptr<PairSource> pair_by_number(TwoViews views, std::optional<RecordingHead> head);

/// Two videos by their times (pairing.h). Times that have nothing in common, of containers that begin to count anywhere, are
/// taken from the first pictures. `skew_ns`: how much later than their times say the right pictures were taken.
std::unique_ptr<PairSource> pair_by_time(TwoViews views, TimeNs skew_ns);

}  // namespace duo
