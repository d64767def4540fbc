// The body tracker on pictures that show no person.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "trackers/body/rendered_person.h"

namespace duo {
namespace {

using test::body_tracker, test::copy_of, test::RenderedPerson;

constexpr int kSearched = 9;  // frames after which every part of the picture was searched once

TEST(BodyNobody, IsAPersonWithoutDepth) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  Frame frame;
  frame.color = person.frames[0]->color.clone();
  frame.disparity.d_q4 = Image<std::uint16_t>(frame.color.size());
  for (int y = 0; y < frame.color.height(); ++y)
    for (int x = 0; x < frame.color.width(); ++x) frame.disparity.d_q4.at(y, x) = Disparity::kNone;
  for (int i = 0; i < kSearched; ++i) EXPECT_TRUE(tracker->track(frame).empty()) << i;
}

TEST(BodyNobody, IsAPosterOfAPerson) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  for (int i = 0; i < kSearched; ++i) {
    Frame frame = copy_of(*person.frames[0]);
    for (int y = 0; y < frame.color.height(); ++y)
      for (int x = 0; x < frame.color.width(); ++x)
        frame.disparity.d_q4.at(y, x) = static_cast<std::uint16_t>(16 * 20 + x / 8 + (x * 7 + y * 3) % 3);  // a wall at a slant
    EXPECT_TRUE(tracker->track(frame).empty()) << i;
  }
}

// Trunk, head, tail and four legs, brown and mottled, 1.5 m away before a wall.
TEST(BodyNobody, IsADog) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  const auto is_dog = [](int x, int y) {
    const auto ellipse = [&](double cx, double cy, double rx, double ry) {
      return (x - cx) * (x - cx) / (rx * rx) + (y - cy) * (y - cy) / (ry * ry) < 1;
    };
    const bool leg = y > 150 && y < 195 &&
                     (std::abs(x - 120) < 5 || std::abs(x - 132) < 5 || std::abs(x - 185) < 5 || std::abs(x - 196) < 5);
    return leg || ellipse(158, 145, 50, 20) || ellipse(215, 118, 20, 16) || ellipse(233, 124, 10, 7) ||
           ellipse(105, 122, 5, 20);
  };
  std::mt19937 random(5);
  for (int i = 0; i < kSearched; ++i) {
    Frame frame = copy_of(*person.frames[0]);
    for (int y = 0; y < frame.color.height(); ++y)
      for (int x = 0; x < frame.color.width(); ++x) {
        const bool dog = is_dog(x, y);
        const auto shade = static_cast<std::uint8_t>((dog ? 90 : 190) + random() % 20);
        const auto paler = [&](int percent) { return static_cast<std::uint8_t>(shade * percent / 100); };
        frame.color.at(y, x) = dog ? Rgb8{shade, paler(70), paler(45)} : Rgb8{shade, shade, paler(92)};
        frame.disparity.d_q4.at(y, x) = dog ? 360 : 180;
      }
    EXPECT_TRUE(tracker->track(frame).empty()) << i;
  }
}

// The room beside the person, and its mirror image where the person is.
TEST(BodyNobody, IsInAnEmptyRoom) {
  const RenderedPerson& person = RenderedPerson::get();
  const auto tracker = body_tracker(person.rig, person.rectified, 1);
  constexpr int kBeside_px = 80;
  for (int i = 0; i < kSearched; ++i) {
    const Frame& room = *person.frames[static_cast<std::size_t>(i)];
    Frame frame = copy_of(room);
    const int width = frame.color.width();
    for (int y = 0; y < frame.color.height(); ++y)
      for (int x = kBeside_px; x < width - kBeside_px; ++x) {
        const int from_left = x / kBeside_px % 2 == 0 ? x % kBeside_px : kBeside_px - 1 - x % kBeside_px;
        const int from_x = x < width / 2 ? from_left : width - 1 - from_left;
        frame.color.at(y, x) = room.color.at(y, from_x);
        frame.disparity.d_q4.at(y, x) = room.disparity.d_q4.at(y, from_x);
      }
    EXPECT_TRUE(tracker->track(frame).empty()) << i;
  }
}

}  // namespace
}  // namespace duo
