// The project's networks: read in time, and the same bits as tools/models/integer_run.py, which shares no code with the
// library.
#include <algorithm>
#include <ctime>
#include <span>
#include <string>
#include <vector>

#include "nets/net_run.h"
#include "tests/agree.h"
#include "tests/model_files.h"

namespace duo {
namespace {

struct Pinned {
  const char *model, *output;
  std::uint64_t hash;
};
// Of integer_run.py for the input of tests/model_files.h.
constexpr Pinned kPinned[] = {
    {"person_detector", "scores_28", 0xae1bb842d56789e3},
    {"person_detector", "boxes_28", 0x6a0552b1abfc2be3},
    {"person_detector", "scores_14", 0x9a0431705a3ced10},
    {"person_detector", "boxes_14", 0xfd40b1f92afe4d38},
    {"person_detector", "scores_7", 0x989fe608ba632f11},
    {"person_detector", "boxes_7", 0xc2f18095ca83d29b},
    {"body_lite", "points", 0x30dc08ae95fbf3c},
    {"body_lite", "presence", 0xb009ff4c871c3a05},
    {"body_lite", "heat", 0xd0ac8ba53c58af3},
    {"body_lite", "world", 0x67616bf7b876fcf9},
    {"body_full", "points", 0x5dba7987f5ec9225},
    {"body_full", "presence", 0xb01ca94c873bf0e3},
    {"body_full", "heat", 0x7104ffb18daa2add},
    {"body_full", "world", 0x1dd2ba46adc46e9b},
    {"hand_lite", "points", 0xd92b7b6dcc3c131d},
    {"hand_lite", "presence", 0xb007354c87177cc7},
    {"hand_lite", "side", 0xb01df44c873e2354},
    {"hand_lite", "world", 0x99b5ab5bd6f48279},
    {"hand_full", "points", 0x44c6bbee4660a7c6},
    {"hand_full", "presence", 0xb03ce44c8772b524},
    {"hand_full", "side", 0xb01daa4c873da596},
    {"hand_full", "world", 0xcd3eae75bde5cea},
};

void expect_pinned(NetRun& run, Pool& pool, const std::string& what) {
  const Net& net = run.net();
  test::fill_input(run.input(), net.tensors[0].range);
  run.run(pool);
  for (const Pinned& pinned : kPinned)
    if (net.name == pinned.model) {
      EXPECT_EQ(test::hash_of(run.tensor(net.output(pinned.output).value())), pinned.hash)
          << net.name << " " << pinned.output << " " << what;
    }
}

/// One number for all outputs, for each of the first pictures, which the pools take in turn, beginning with `first`.
std::vector<std::uint64_t> hashes_of(NetRun& run, int pictures, std::span<Pool* const> pools, std::size_t first = 0) {
  std::vector<std::uint64_t> out;
  for (int number = 0; number < pictures; ++number) {
    test::fill_input(run.input(), run.net().tensors[0].range, number);
    run.run(*pools[(first + static_cast<std::size_t>(number)) % pools.size()]);
    std::string hashes;
    for (const NetOutput& output : run.net().outputs) {
      const std::uint64_t hash = test::hash_of(run.tensor(output.tensor));
      hashes.append(reinterpret_cast<const char*>(&hash), sizeof(hash));
    }
    out.push_back(hash_words(hashes));
  }
  return out;
}

class Models : public testing::TestWithParam<const char*> {};

TEST_P(Models, AreReadIn50Ms) {
  constexpr double kMost_ms = 50;
  double least_ms = 1e9;
  for (int i = 0; i < 3 || (least_ms >= kMost_ms && i < 30); ++i) {
    const std::clock_t begin = std::clock();  // of the processor: the machine may have other work
    const auto net = read_net(test::model_path(GetParam()));
    least_ms = std::min(least_ms, 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    ASSERT_TRUE(net) << net.error().what;
  }
  RecordProperty("read_ms", std::to_string(least_ms));
  std::printf("read in %.1f ms\n", least_ms);
#ifdef NDEBUG  // sanitizers watch every byte
  EXPECT_LT(least_ms, kMost_ms);
#endif
}

TEST_P(Models, PlainLoopsGiveTheToolsBits) {
  const auto net = read_net(test::model_path(GetParam()));
  ASSERT_TRUE(net) << net.error().what;
  Pool pool(1);
  NetRun run(*net, NetRun::Loops::kPlain);
  expect_pinned(run, pool, "plain");
  EXPECT_LT(run.memory_bytes(), 7u << 20);
}

// What has no vectors is slow, and takes eight pictures in a long run alone, else one for each number of threads.
TEST_P(Models, EightPicturesHaveOneHashOnEveryInstructionSetAndNumberOfThreads) {
  const auto net = read_net(test::model_path(GetParam()));
  ASSERT_TRUE(net) << net.error().what;
  Pool one(1), two(2), five(5);
  Pool* const pools[] = {&one, &two, &five};
  NetRun plain(*net, NetRun::Loops::kPlain), vectors(*net, NetRun::Loops::kVectors);
  const int few = test::long_run() ? 8 : 3;
  const std::vector<std::uint64_t> want_of_few = hashes_of(plain, few, {pools, 1});
  const std::vector<std::uint64_t> want = hashes_of(vectors, 8, {pools, 1});
  EXPECT_TRUE(std::equal(want_of_few.begin(), want_of_few.end(), want.begin()));
  std::size_t first = 0;
  test::each_target([&](const std::string& target) {
    const std::vector<std::uint64_t> got = hashes_of(vectors, target == "EMU128" ? few : 8, pools, first);
    EXPECT_TRUE(std::equal(got.begin(), got.end(), want.begin()))
        << target << ", " << pools[first % 3]->threads() << " threads first";
    ++first;
  });
}

INSTANTIATE_TEST_SUITE_P(, Models, testing::Values("person_detector", "body_lite", "body_full", "hand_lite", "hand_full"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace duo
