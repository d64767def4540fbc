#include "stages/balance/balance_vk.h"

#include "stages/types/clear.h"
#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

void expect_agrees(vk::Device& device, const vk::Balance& balance, vk::Recorder& recorder, Size size, test::Fill how,
                   const std::string& where) {
  std::mt19937 rng(5);
  Image<std::uint8_t> left(size), right(size), left_inside(size), right_inside(size);
  test::fill(left.view(), how, rng);
  test::fill(right.view(), test::Fill::kRandom, rng);
  if (how == test::Fill::kRandom)  // here cells find each other, 16 px apart
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x + 16 < size.width; ++x) right.at(y, x) = static_cast<std::uint8_t>(left.at(y, x + 16) / 2 + 9);
  for (auto* inside : {&left_inside, &right_inside}) {
    test::fill(inside->view(), test::Fill::kHigh, rng);
    for (int hole = 0; hole < 3; ++hole)
      inside->at(static_cast<int>(rng() % static_cast<unsigned>(size.height)),
                 static_cast<int>(rng() % static_cast<unsigned>(size.width))) = 0;
  }
  const auto scratch = must(vk::Balance::Scratch::make(device, size));
  for (const bool masked : {false, true}) {
    GrayPair pair{left, right};
    if (masked) pair.left_inside = left_inside, pair.right_inside = right_inside;
    Image<std::uint8_t> want(size);
    const int max_disparity = masked ? 40 : 256;
    const std::int32_t known = masked ? 3 : -3;
    const auto clear = must(vk::make_filled(device, "clear", std::as_bytes(std::span(&known, 1))));
    ref::balance(pair, max_disparity, masked ? kClearUnbalanced : 0, want);

    const OnDevice<std::uint8_t> l(device, left, "left"), r(device, right, "right"), li(device, left_inside, "left inside"),
        ri(device, right_inside, "right inside"), dst(device, size, "dst");
    vk::Balance::Input input{l.view(), r.view()};
    if (masked) input.left_inside = li.view(), input.right_inside = ri.view();
    test::run_with(
        recorder, [&] { balance.record(recorder, input, max_disparity, &clear, scratch, dst.view(), size); }, l, r, li, ri,
        dst);
    const std::string what = std::string("balance") + (masked ? " masked" : "") + where;
    test::expect_same<std::uint8_t>(want, dst.pixels(what), what);
  }
}

// Flat pictures are shifted by their difference; of clear ones 8 levels are left.
TEST(BalanceVk, LittleIsLeftAlone) {
  test::each_device([](vk::Device& device, const std::string& where) {
    const auto balance = must(vk::Balance::make(device));
    auto recorder = must(vk::Recorder::make(device));
    const Size size{96, 96};
    const auto scratch = must(vk::Balance::Scratch::make(device, size));
    for (const int by : {8, 9})
      for (const int known : {1, -1}) {
        const auto left = test::constant<std::uint8_t>(size, static_cast<std::uint8_t>(100 + by)),
                   right = test::constant<std::uint8_t>(size, 100);
        Image<std::uint8_t> want(size);
        ref::balance({left, right}, 16, known > 0 ? kClearUnbalanced : 0, want);
        const auto clear = must(vk::make_filled(device, "clear", std::as_bytes(std::span(&known, 1))));
        const OnDevice<std::uint8_t> l(device, left, "left"), r(device, right, "right"), dst(device, size, "dst");
        test::run_with(
            recorder,
            [&] {
              balance.record(recorder, {l.view(), r.view()}, 16, &clear, scratch, dst.view(), size);
            },
            l, r, dst);
        const auto got = dst.pixels("balance" + where);
        EXPECT_EQ(got.at(40, 40), by == 8 && known > 0 ? 100 : 100 + by) << where;
        test::expect_same<std::uint8_t>(want, got, "balance" + where);
      }
  });
}

TEST(BalanceVk, Agrees) {
  test::each_device([](vk::Device& device, const std::string& where) {
    const auto balance = must(vk::Balance::make(device));
    auto recorder = must(vk::Recorder::make(device));
    for (const Size size : {Size{1, 1}, Size{3, 200}, Size{131, 37}, Size{17, 300}, Size{643, 90}})
      for (const test::Fill how : test::kFills) {
        expect_agrees(device, balance, recorder, size, how, where);
        if (::testing::Test::HasFailure()) return;
      }
  });
}

}  // namespace
}  // namespace duo
