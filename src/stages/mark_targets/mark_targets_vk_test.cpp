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
    for (const Size size : {Size{1, 1}, Size{17, 5}, Size{65, 11}, Size{131, 37}})
      for (const int depths : {0, 1, 2}) {
        Image<std::uint8_t> hue(size), saturation(size), value(size), want(size);
        for (auto* plane : {&hue, &saturation, &value}) test::fill(plane->view(), test::Fill::kRandom, rng);
        Image<std::uint16_t> d(size), background(size);
        for (auto* plane : {&d, &background}) test::fill_disparity(plane->view(), rng);

        const test::OnDevice<std::uint8_t> hue_vk(device, hue, "hue"), saturation_vk(device, saturation, "saturation"),
            value_vk(device, value, "value"), marks_vk(device, size, "marks");
        const test::OnDevice<std::uint16_t> d_vk(device, d, "disparity"), background_vk(device, background, "background");
        const test::Records<std::byte> wanted(device, vk::MarkTargets::wanted_bytes(2), "targets");
        vk::MarkTargets::Input in{hue_vk.view(), saturation_vk.view(), value_vk.view()};
        if (depths > 0) in.d_q4 = d_vk.view();
        if (depths > 1) in.background_q4 = background_vk.view();
        in.wanted = &wanted.buffer();
        recorder.begin();
        for (const auto* plane : {&hue_vk, &saturation_vk, &value_vk, &marks_vk}) plane->record_upload(recorder);
        for (const auto* plane : {&d_vk, &background_vk}) plane->record_upload(recorder);
        wanted.record_upload(recorder);
        stage.record(recorder, in, marks_vk.view(), size);
        marks_vk.record_download(recorder);
        test::must(recorder.end());

        for (int round = 0; round < 4; ++round) {
          std::vector<ColorLikelihood> likelihoods(2);
          for (auto& table : likelihoods)
            for (auto& bin : table) bin = static_cast<std::uint8_t>(rng());
          std::vector<Target> targets(round == 3 ? kMaxTargets : rng() % kMaxTargets);
          for (Target& target : targets) target = test::random_target(rng, size, 2);
          duo::MarkTargets all{hue, saturation, value, {}, {}, targets, likelihoods};
          if (depths > 0) all.d_q4 = d;
          if (depths > 1) all.background_q4 = background;
          ref::mark_targets(all, want.view());
          vk::MarkTargets::write(targets, likelihoods, wanted.bytes());
          test::must(recorder.run());
          test::expect_same<std::uint8_t>(want, marks_vk.pixels("mark_targets" + where), "mark_targets" + where);
          if (HasFailure()) return;
        }
      }
  });
}

}  // namespace
}  // namespace duo
