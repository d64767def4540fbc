#include "stages/mark_targets/mark_targets_vk.h"

#include "tests/records_vk.h"
#include "tests/targets.h"

namespace duo {
namespace {

// One recording for several sets of targets: they change from frame to frame.
TEST(MarkTargetsVk, Agrees) {
  test::each_device([&](vk::Device& device, const std::string& where) {
    std::mt19937 rng(6);
    const auto stage = test::must(vk::MarkTargets::make(device));
    auto recorder = test::must(vk::Recorder::make(device));
    for (const Size size : {Size{1, 1}, Size{17, 5}, Size{65, 11}, Size{131, 37}}) {
      Image<std::uint8_t> hue(size), saturation(size), value(size), want(size);
      for (auto* plane : {&hue, &saturation, &value}) test::fill(plane->view(), test::Fill::kRandom, rng);
      const test::OnDevice<std::uint8_t> hue_vk(device, hue, "hue"), saturation_vk(device, saturation, "saturation"),
          value_vk(device, value, "value"), marks_vk(device, size, "marks");
      const test::Records<std::byte> targets_vk(device, vk::MarkTargets::target_bytes(), "targets");
      recorder.begin();
      for (const auto* plane : {&hue_vk, &saturation_vk, &value_vk, &marks_vk}) plane->record_upload(recorder);
      targets_vk.record_upload(recorder);
      stage.record(recorder, {hue_vk.view(), saturation_vk.view(), value_vk.view(), &targets_vk.buffer()}, marks_vk.view(),
                   size);
      marks_vk.record_download(recorder);
      test::must(recorder.end());

      for (int round = 0; round < 8; ++round) {
        std::vector<Target> targets(round == 7 ? kMaxTargets : rng() % kMaxTargets);
        for (Target& target : targets) target = test::random_target(rng, size);
        ref::mark_targets({hue, saturation, value, targets}, want.view());
        vk::MarkTargets::write(targets, targets_vk.bytes());
        test::must(recorder.run());
        test::expect_same<std::uint8_t>(want, marks_vk.pixels("mark_targets" + where), "mark_targets" + where);
        if (HasFailure()) return;
      }
    }
  });
}

}  // namespace
}  // namespace duo
