// A detector that follows one person through a clip, each region from the last result.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "detectors/place.h"
#include "detectors/see_points.h"
#include "duoptic/detector.h"
#include "duoptic/source.h"
#include "tests/agree.h"
#include "tests/model_files.h"

namespace duo::test {

/// The left pictures of a clip of the test data; empty where that is absent.
inline std::vector<Picture> pictures_of(const std::string& clip) {
  std::vector<Picture> out;
  const auto source = open_source(data_folder() / "sequences" / clip / "left.avi");
  if (!source) return out;
  for (Picture picture;; picture = {}) {
    const auto next = (*source)->next(picture);
    if (!next || *next != Next::kNew) return out;
    out.push_back(std::move(picture));
  }
}

/// Where the detector finds the person in the first picture.
inline TurnedSquare start_in(const Picture& picture) {
  const auto detector = make_detector({.body = BodyModel::kLite});
  const auto found =
      detector ? (*detector)->find(picture.pixels, Window::all(picture.pixels.size())) : std::span<const FoundPerson>();
  return found.empty() ? TurnedSquare() : found[0].region;
}

/// All points of `count` pictures as one number.
inline std::uint64_t hash_of_loop(const std::vector<Picture>& pictures, std::size_t count, const DetectorOptions& options) {
  const auto detector = make_detector(options);
  if (!detector) {
    ADD_FAILURE() << detector.error().what;
    return 0;
  }
  TurnedSquare region = start_in(pictures[0]);
  std::string places;
  for (std::size_t i = 0; i < std::min(count, pictures.size()); ++i) {
    const Look look{pictures[i].pixels, region};
    SeenBody body;
    (*detector)->bodies({&look, 1}, {&body, 1});
    EXPECT_GE(body.score_q15, 16384) << i;
    region = body.next;
    for (const SeenPoint& point : body.points)
      for (const std::int32_t value : {point.x_q8, point.y_q8, point.z_q8, std::int32_t{point.visible_q15}})
        places.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  return hash_words(places);
}

}  // namespace duo::test
