// What `bench --clip` measures: the whole way from two videos to joints, part by part.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "duoptic/result.h"

namespace duo::app::bench_chain {

struct What {
  std::vector<std::string> clips;  // folders with left.avi, right.avi and calibration_truth.yml
  std::string engine;
  bool whole = false;  // match each frame as a whole
  int repeat = 1;
  bool json = false;  // else each clip's table is printed as soon as it is known
};

/// Of each clip: CPU time and bytes a frame of each part, while one thread does one part after the other; and frames/s, CPU
/// time and busy cores of `duoptic track` with one thread and with two. Means over the clip's frames, medians over the runs,
/// which take turns.
///
/// Errors  those of load_rig(), open_pairs(), Pipeline and make_json_lines(); no room for the lines
Result<nlohmann::json> tables(const What& what);

}  // namespace duo::app::bench_chain
