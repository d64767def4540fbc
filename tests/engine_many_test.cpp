// Several frames at once by one engine.
#include <algorithm>
#include <string>
#include <vector>

#include "tests/agree.h"
#include "tests/allocations.h"
#include "tests/engine_setups.h"

namespace duo {
namespace {

using test::kChoices, test::Choice, test::low_texture, test::prepared, test::raw_setup, test::run;

void expect_same_maps(const Frame& want, const Frame& got, const std::string& who) {
  EXPECT_EQ(want.sequence, got.sequence) << who;
  test::expect_same<std::uint8_t>(want.left, got.left, who + " left");
  test::expect_same<std::uint16_t>(want.disparity.d_q4, got.disparity.d_q4, who + " disparity");
  test::expect_same<std::uint16_t>(want.depth_mm, got.depth_mm, who + " depth");
}

// Several frames at once are those of one after the other, in the order of their pairs, each with the windows it was given; and
// one that is worked on stays until the next was collected.
TEST(Engine, ManyAtOnceAreThoseOfOneAfterTheOther) {
  constexpr int kPairs = 9;
  std::vector<SyntheticPair> scenes;
  for (int i = 0; i < kPairs; ++i) {
    SyntheticSetup synthetic;
    synthetic.size = {96, 64};
    synthetic.seed += static_cast<unsigned>(i);
    scenes.push_back(render_synthetic(synthetic, 2));
    scenes.back().pair.sequence = static_cast<std::uint64_t>(i);
    scenes.back().rig = scenes[0].rig;
  }
  const auto windows_of = [](int i) { return i % 3 == 1 ? std::vector<Window>{{10, 5 * i, 30, 20}} : std::vector<Window>{}; };
  for (const Choice& choice : kChoices) {
    duo::Setup setup = raw_setup(scenes[0], choice);
    const auto one = prepared("simd", 1, setup);
    EXPECT_EQ(one->in_flight(), 1);
    setup.many_at_once = true;
    for (const int threads : {1, 2, 3, 7}) {
      const auto many = prepared("simd", threads, setup);
      EXPECT_EQ(many->in_flight(), std::min(threads, 4));
      std::shared_ptr<const Frame> last;
      for (int i = 0, submitted = 0; i < kPairs; ++i) {
        for (; submitted < std::min(kPairs, i + many->in_flight()); ++submitted) {
          many->look_at(windows_of(submitted));
          many->submit(scenes[static_cast<std::size_t>(submitted)].pair);
        }
        const std::shared_ptr<const Frame> got = many->collect();
        const std::string who = std::string(choice.matcher) + " " + choice.preset + " " + std::to_string(threads) +
                                " threads, frame " + std::to_string(i);
        if (last != nullptr) {
          one->look_at(windows_of(i - 1));
          expect_same_maps(*run(*one, scenes[static_cast<std::size_t>(i - 1)].pair), *last, who + ", the one before");
        }
        one->look_at(windows_of(i));
        expect_same_maps(*run(*one, scenes[static_cast<std::size_t>(i)].pair), *got, who);
        last = got;
      }
    }
  }
}

// A stream that begins sharp and becomes blurred is matched as a clear one for as many pairs whoever makes how many at once,
// and begins anew with each prepare().
TEST(Engine, ManyAtOnceSettleWhatIsClear) {
  constexpr int kSharp = 5, kPairs = kSharp + 40;
  std::vector<Pair> pairs;
  for (int i = 0; i < kPairs; ++i) pairs.push_back(low_texture(i < kSharp, static_cast<unsigned>(i)));
  duo::Setup setup;
  setup.size = pairs[0].left.pixels.size();
  setup.max_disparity = 16;
  const auto one_after_the_other = [&](const char* name, const duo::Setup& how) {
    const auto engine = prepared(name, 1, how);
    std::vector<Image<std::uint16_t>> found;
    for (const Pair& pair : pairs) found.push_back(run(*engine, pair)->disparity.d_q4.clone());
    return found;
  };
  const auto same = [](const Image<std::uint16_t>& a, const Image<std::uint16_t>& b) {
    for (int y = 0; y < a.height(); ++y)
      if (!std::equal(a.row(y), a.row(y) + a.width(), b.row(y))) return false;
    return true;
  };
  const auto want = one_after_the_other("ref", setup);
  duo::Setup forced = setup;
  forced.parameters = {{"clear", 2}};
  const auto clear = one_after_the_other("simd", forced);
  forced.parameters = {{"clear", 0}};
  const auto unclear = one_after_the_other("simd", forced);
  for (int i = 0; i < kPairs; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const bool is_clear = i < kSharp + 29;  // the 30th blurred pair in a row is believed
    EXPECT_FALSE(same(clear[at], unclear[at])) << i;
    EXPECT_TRUE(same(want[at], is_clear ? clear[at] : unclear[at])) << i;
  }
  setup.many_at_once = true;
  for (const int threads : {1, 3, 4}) {
    const auto many = prepared("simd", threads, setup);
    for (int round = 0; round < 2; ++round) {
      ASSERT_TRUE(many->prepare(setup));
      for (int i = 0, submitted = 0; i < kPairs; ++i) {
        for (; submitted < std::min(kPairs, i + many->in_flight()); ++submitted)
          many->submit(pairs[static_cast<std::size_t>(submitted)]);
        const auto at = static_cast<std::size_t>(i);
        if (!test::expect_same<std::uint16_t>(want[at], many->collect()->disparity.d_q4,
                                              std::to_string(threads) + " threads, frame " + std::to_string(i)))
          return;
      }
    }
  }
}

// Pairs in flight are finished first; a setup that is refused changes nothing.
TEST(Engine, ManyAtOnceEndInTheMiddle) {
  SyntheticSetup synthetic;
  synthetic.size = {160, 120};
  const SyntheticPair scene = render_synthetic(synthetic, 2);
  duo::Setup setup = raw_setup(scene, kChoices[0]);
  setup.many_at_once = true;
  const auto engine = prepared("simd", 3, setup);
  engine->submit(scene.pair);
  engine->submit(scene.pair);
  duo::Setup wrong = setup;
  wrong.matcher = "none";
  EXPECT_FALSE(engine->prepare(wrong));
  EXPECT_EQ(engine->collect()->disparity.d_q4.size(), engine->rectified()->size);
  engine->submit(scene.pair);
  EXPECT_TRUE(engine->prepare(setup));
  engine->submit(scene.pair);  // nobody collects it
}

TEST(Engine, ManyAtOnceAllocateNothing) {
  SyntheticSetup synthetic;
  synthetic.size = {160, 120};
  const SyntheticPair scene = render_synthetic(synthetic, 2);
  for (const Choice& choice : kChoices) {
    duo::Setup setup = raw_setup(scene, choice);
    setup.many_at_once = true;
    const auto many = prepared("simd", 2, setup);
    const auto both = [&] {
      many->submit(scene.pair);
      many->submit(scene.pair);
      many->collect();
      many->collect();
    };
    both();
    const long before_many = test::allocations;
    for (int i = 0; i < 3; ++i) both();
    EXPECT_EQ(test::allocations - before_many, 0) << choice.matcher << " " << choice.preset << " two at once";
  }
}

}  // namespace
}  // namespace duo
