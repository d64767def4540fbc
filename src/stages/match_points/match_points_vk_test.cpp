#include "stages/match_points/match_points_vk.h"

#include "tests/records_vk.h"
#include "tests/sift_points.h"

namespace duo {
namespace {

struct Lists {
  std::vector<SiftPoints> stored, seen;
};

// Four pairs of lists at once, from empty to as long as they can be, longer than a workgroup has invocations.
Lists random_lists(std::mt19937& rng) {
  Lists out;
  for (const int count : {0, 2, 33, 150}) out.stored.push_back(test::random_points(count, rng));
  for (const int count : {17, 1, 64, 140}) out.seen.push_back(test::random_points(count, rng));
  return out;
}

TEST(MatchPointsVk, Agrees) {
  constexpr SiftListShape kStored{4, 150}, kSeen{4, 160};
  test::each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(7);
    const auto stage = test::must(vk::MatchPoints::make(device));
    auto recorder = test::must(vk::Recorder::make(device));
    const test::Records<std::byte> stored(device, sift_list_bytes(kStored), "stored"),
        seen(device, sift_list_bytes(kSeen), "seen");
    const test::Records<PredictedPlace> predicted(device, 4 * 150, "predicted");
    const test::Records<PointMatch> matches(device, 4 * 150, "matches");
    int found = 0;
    for (const bool gated : {false, true})
      for (const bool mutual : {false, true}) {
        const auto [all_stored, all_seen] = random_lists(rng);
        std::vector<std::vector<PredictedPlace>> places(4);
        auto* place = reinterpret_cast<PredictedPlace*>(predicted.bytes().data());
        for (int list = 0; list < 4; ++list) {
          const auto i = static_cast<std::size_t>(list);
          write_sift_list(all_stored[i], kStored, list, stored.bytes());
          write_sift_list(all_seen[i], kSeen, list, seen.bytes());
          for (int k = 0; k < all_stored[i].count; ++k) {
            place[list * 150 + k] = {all_stored[i][k].x_px, all_stored[i][k].y_px};
            if (gated) places[i].push_back(place[list * 150 + k]);
          }
        }
        MatchPointsParams params;
        params.mutual = mutual;
        params.ratio_percent = 95;
        recorder.begin();
        stored.record_upload(recorder);
        seen.record_upload(recorder);
        predicted.record_upload(recorder);
        stage.record(recorder, {&stored.buffer(), &seen.buffer(), gated ? &predicted.buffer() : nullptr, kStored, kSeen},
                     params, matches.buffer());
        matches.record_download(recorder);
        test::must(recorder.end());
        test::must(recorder.run());
        const auto got = matches.read();
        for (std::size_t list = 0; list < 4; ++list) {
          std::vector<PointMatch> want(static_cast<std::size_t>(all_stored[list].count));
          ref::match_points(all_stored[list], places[list], all_seen[list], params, want);
          want.resize(150);
          for (std::size_t i = 0; i < 150; ++i) {
            EXPECT_EQ(got[list * 150 + i], want[i]) << "match_points" << where << " list " << list << " point " << i;
            found += want[i].seen != PointMatch::kNone;
          }
        }
        if (HasFailure()) return;
      }
    EXPECT_GT(found, 30);  // the comparison is not about nothing
  });
}

}  // namespace
}  // namespace duo
