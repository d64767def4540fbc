#include "nets/net_vk.h"

#include "nets/net_run.h"
#include "tests/agree_vk.h"
#include "tests/model_files.h"

namespace duo {
namespace {

class NetVk : public testing::TestWithParam<const char*> {};

TEST_P(NetVk, GivesTheBitsOfTheProcessor) {
  const std::string model = GetParam();
  if (test::assisted() && model != "hand_lite")
    GTEST_SKIP() << "a hundred times slower; one model has all kinds of layers but two";
  if (const char* const width = std::getenv("LP_NATIVE_VECTOR_WIDTH");
      !test::long_run() && width != nullptr && std::string(width) != "256" && model != "body_lite" && model != "hand_lite")
    GTEST_SKIP() << "skipped: only with DUOPTIC_LONG; stages/vk has every layer at every width";
  constexpr int kAtOnce = 2;
  const int pictures = test::long_run() ? 8 : kAtOnce, runs = std::max(2, pictures / kAtOnce);
  const auto net = test::must(read_net(test::model_path(model)));
  NetRun on_processor(net, NetRun::Loops::kVectors);
  Pool pool(1);
  std::vector<std::vector<std::uint64_t>> want;
  for (int picture = 0; picture < pictures; ++picture) {
    test::fill_input(on_processor.input(), net.tensors[0].range, picture);
    on_processor.run(pool);
    want.emplace_back();
    for (const NetOutput& output : net.outputs) want.back().push_back(test::hash_of(on_processor.tensor(output.tensor)));
  }
  EXPECT_NE(want[0], want[1]);
  test::each_device([&](vk::Device& device, const std::string& where) {
    const auto on_device = test::must(vk::DeviceNet::make(device, net, kAtOnce));
    for (int run = 0; run < runs; ++run) {  // again: nothing of the first may be left
      const auto number = [&](int place) { return (kAtOnce * run + (place + run) % kAtOnce) % pictures; };
      for (int place = 0; place < kAtOnce; ++place)
        test::fill_input(on_device->input(place), net.tensors[0].range, number(place));
      test::must(on_device->run());
      for (int place = 0; place < kAtOnce; ++place)
        for (std::size_t i = 0; i < net.outputs.size(); ++i)
          EXPECT_EQ(test::hash_of(on_device->output(net.outputs[i].tensor, place)),
                    want[static_cast<std::size_t>(number(place))][i])
              << net.name << " " << net.outputs[i].name << where << " place " << place << " run " << run;
    }
  });
}

INSTANTIATE_TEST_SUITE_P(, NetVk, testing::Values("person_detector", "body_lite", "body_full", "hand_lite", "hand_full"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace duo
