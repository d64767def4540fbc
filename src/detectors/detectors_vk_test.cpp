#include "duoptic/detector.h"
#include "tests/agree_vk.h"
#include "tests/closed_loop.h"

namespace duo {
namespace {

bool same(const SeenPoint& a, const SeenPoint& b) {
  return a.x_q8 == b.x_q8 && a.y_q8 == b.y_q8 && a.z_q8 == b.z_q8 && a.world_q16 == b.world_q16 &&
         a.visible_q15 == b.visible_q15;
}

// Three regions of a picture of waves: two in one recording, and one.
TEST(DetectorVk, GivesTheBitsOfTheProcessor) {
  if (test::assisted()) GTEST_SKIP() << "a hundred times slower; networks are looked at by themselves";
  Image<Rgb8> picture({320, 240});
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x)
      picture.at(y, x) = {static_cast<std::uint8_t>(5 * x + y), static_cast<std::uint8_t>(3 * y),
                          static_cast<std::uint8_t>(x * y / 64)};
  const Look looks[] = {{picture.view(), {160 * 256, 120 * 256, 90 * 256, 0}},
                        {picture.view(), {100 * 256, 90 * 256, 60 * 256, 30 * 256}},
                        {picture.view(), {250 * 256, 200 * 256, 0, 80 * 256}}};
  const auto on_processor = test::must(make_detector({.body = BodyModel::kLite, .hands = true}));
  SeenBody want[3];
  SeenHand want_hands[3];
  on_processor->bodies(looks, want);
  on_processor->hands(looks, want_hands);
  test::each_device([&](vk::Device& device, const std::string& where) {
    const auto on_device = test::must(make_detector({.body = BodyModel::kLite, .hands = true, .device = device.info().name}));
    SeenBody got[3];
    SeenHand got_hands[3];
    on_device->bodies(looks, got);
    on_device->hands(looks, got_hands);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(got[i].score_q15, want[i].score_q15) << where;
      EXPECT_EQ(got[i].next, want[i].next) << where;
      EXPECT_EQ(got_hands[i].right_q15, want_hands[i].right_q15) << where;
      for (std::size_t k = 0; k < kBodyPoints; ++k)
        EXPECT_TRUE(same(got[i].points[k], want[i].points[k])) << where << " point " << k;
      for (std::size_t k = 0; k < kHandPoints; ++k) EXPECT_TRUE(same(got_hands[i].points[k], want_hands[i].points[k])) << where;
    }
  });
}

TEST(DetectorVk, ClosedLoopHasTheHashOfTheProcessor) {
  const auto pictures = test::pictures_of("dev_easy_wave");
  if (pictures.empty()) GTEST_SKIP() << "skipped: no data";
  const std::size_t count = test::long_run() ? pictures.size() : 3;
  for (const BodyModel body : {BodyModel::kLite, BodyModel::kFull}) {
    if (body == BodyModel::kFull && !test::long_run()) continue;
    const std::uint64_t want = test::hash_of_loop(pictures, count, {.body = body});
    test::each_device([&](vk::Device& device, const std::string& where) {
      EXPECT_EQ(test::hash_of_loop(pictures, count, {.body = body, .device = device.info().name}), want) << where;
    });
  }
}

}  // namespace
}  // namespace duo
