// A matcher that is added to the list is known to all that work by the list: its name, its parameters, its checks and both
// engines.

#include "matchers/matchers.h"
#include "tests/agree.h"

namespace duo {
namespace {

struct FlatParams {
  int disparity = 3;
};
constexpr Parameter<FlatParams> kFlatParameters[] = {{"disparity", &FlatParams::disparity, "px", 0, 9, "of all pixels"}};
constexpr std::string_view kFlatPresets[] = {"default"};

/// Gives all pixels one disparity.
struct Flat {
  FlatParams params;
  Flat(const FlatParams& with, const MatchSetup&) : params(with) {}
  Flat(Pool&, const FlatParams& with, const MatchSetup&) : params(with) {}
  void match(const GrayPair& pair, const Match& out, StageTimer&, RowBand = {}) const {
    for (int y = 0; y < pair.size().height; ++y)
      std::fill_n(out.d_q4.row(y), pair.size().width, static_cast<std::uint16_t>(16 * params.disparity));
  }
};

struct FlatMatcher {
  static constexpr std::string_view kName = "flat";
  static constexpr std::span<const std::string_view> kPresets = kFlatPresets;
  static constexpr std::span<const Parameter<FlatParams>> kParameters = kFlatParameters;
  static constexpr int kMaxDisparity = 10;
  static constexpr bool kTellsConfidence = false, kTakesColor = false, kFills = false;
  using Params = FlatParams;
  static Result<Params> params(std::string_view, const Overrides& overrides) {
    Params out;
    DUO_TRY(override_parameters<Params>("matcher flat", kFlatParameters, overrides, out));
    return out;
  }
  struct Simd : Flat {
    using Flat::Flat;
  };
  using Ref = Flat;
  using Vulkan = Flat;
};

using WithFlat = MatcherList<SgmMatcher, PyramidMatcher, FlatMatcher>;

Setup flat_setup() {
  Setup setup;
  setup.matcher = "flat";
  setup.max_disparity = 10;
  setup.parameters = {{"disparity", 7}};
  return setup;
}

TEST(AddedMatcher, IsListed) {
  EXPECT_EQ(WithFlat::names(), (std::vector<std::string>{"sgm", "pyramid", "flat"}));
  EXPECT_EQ(WithFlat::presets("flat"), std::vector<std::string>{"default"});
  const auto parameters = WithFlat::parameters("flat", "default");
  ASSERT_TRUE(parameters);
  ASSERT_EQ(parameters->size(), 1u);
  EXPECT_EQ(parameters->front().name, "disparity");
  EXPECT_EQ(parameters->front().value, 3);
  EXPECT_NE(Matchers::parameters("flat", "default").error().what.find("choose one of: sgm, pyramid"), std::string::npos);
}

TEST(AddedMatcher, IsChecked) {
  ASSERT_TRUE(WithFlat::choose(flat_setup()));
  duo::Setup setup = flat_setup();
  setup.max_disparity = 11;
  EXPECT_NE(
      WithFlat::choose(setup).error().what.find("searches at most 10 disparities, not 11; lower it, or choose matcher sgm "
                                                "or pyramid"),
      std::string::npos);
  setup = flat_setup();
  setup.wants.confidence = true;
  EXPECT_NE(WithFlat::choose(setup).error().what.find("choose matcher sgm, or do not ask"), std::string::npos);
  setup = flat_setup();
  setup.parameters = {{"disparity", 10}};
  EXPECT_NE(WithFlat::choose(setup).error().what.find("not a whole number in 0 .. 9"), std::string::npos);
}

TEST(AddedMatcher, RunsLikeTheOthers) {
  const auto choice = WithFlat::choose(flat_setup());
  ASSERT_TRUE(choice);
  const Image<std::uint8_t> gray = test::constant<std::uint8_t>({5, 4}, 90);
  Image<std::uint16_t> got(gray.size());
  StageTimer timer;
  WithFlat::Ref plain;
  WithFlat::make(*choice, {gray.size(), 10}, plain);
  std::visit([&](auto& matcher) { matcher.match({gray, gray}, {got}, timer); }, *plain);
  test::expect_same<std::uint16_t>(test::constant<std::uint16_t>(gray.size(), 112), got, "on plain loops");
  Pool pool(1);
  WithFlat::Simd fast;
  WithFlat::make(pool, *choice, {gray.size(), 10}, fast);
  std::visit([&](auto& matcher) { matcher.match({gray, gray}, {got}, timer, RowBand{}); }, *fast);
  test::expect_same<std::uint16_t>(test::constant<std::uint16_t>(gray.size(), 112), got, "on a pool");
}

}  // namespace
}  // namespace duo
