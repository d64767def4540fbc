#include "stages/halve/halve_vk.h"

#include "tests/agree_vk.h"

namespace duo {
namespace {

using test::must;
using test::OnDevice;

template <class Ref, class Record>
void agree_half_vk(const std::string& name, Ref ref, Record record) {
  test::each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(4);
    const auto halve = must(vk::Halve::make(device));
    auto recorder = must(vk::Recorder::make(device));
    for (const Size size : test::awkward_sizes())
      for (const test::Fill how : test::kFills) {
        Image<std::uint8_t> src(size), want(half_of(size));
        test::fill(src.view(), how, rng);
        ref(src, want);
        const OnDevice<std::uint8_t> in(device, src, "src"), out(device, half_of(size), "dst");
        test::run_with(
            recorder, [&] { record(halve, recorder, in.view(), out.view(), size); }, in, out);
        test::expect_same<std::uint8_t>(want, out.pixels(name + where), name + where);
        if (::testing::Test::HasFailure()) return;
      }
  });
}

TEST(HalveVk, Agrees) {
  agree_half_vk(
      "halve", [](auto& src, auto& dst) { ref::halve(src, dst); },
      [](const vk::Halve& halve, auto& recorder, auto src, auto dst, Size size) { halve.record(recorder, src, dst, size); });
}

TEST(HalveVk, InsideAgrees) {
  agree_half_vk(
      "halve_inside", [](auto& src, auto& dst) { ref::halve_inside(src, dst); },
      [](const vk::Halve& halve, auto& recorder, auto src, auto dst, Size size) {
        halve.record_inside(recorder, src, dst, size);
      });
}

}  // namespace
}  // namespace duo
