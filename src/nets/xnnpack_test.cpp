// The project's networks beside XNNPACK's floating point in one process: nearly the same results, in less time.
#include <cmath>
#include <ctime>
#include <map>

#include "nets/float_peer.h"
#include "nets/net_run.h"
#include "tests/agree.h"
#include "tests/model_files.h"

namespace duo {
namespace {

/// Milliseconds of this thread's processor time.
template <class F>
double thread_ms(F&& f) {
  timespec begin, end;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
  f();
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
  return 1e3 * static_cast<double>(end.tv_sec - begin.tv_sec) + 1e-6 * static_cast<double>(end.tv_nsec - begin.tv_nsec);
}

class BesideXnnpack : public testing::TestWithParam<const char*> {};

// Both take turns, least of 20. The deviation is that of an output as a whole, the roots of the mean squares compared.
TEST_P(BesideXnnpack, NearlyTheSameAndNeverSlower) {
  const auto net = read_net(test::model_path(GetParam()));
  ASSERT_TRUE(net) << net.error().what;
  NetRun ours(*net, NetRun::Loops::kVectors);
  const auto made = FloatPeer::make(*net, 1);
  ASSERT_TRUE(made) << made.error().what;
  FloatPeer& floats = **made;
  Pool one(1);
  double ours_ms = 1e9, floats_ms = 1e9;
  std::map<std::string, std::pair<double, double>> squares;  // of an output's deviations and values
  for (int i = 0; i < 20; ++i) {
    test::fill_input(ours.input(), net->tensors[0].range, i % 8);
    for (std::size_t k = 0; k < ours.input().count(); ++k)
      floats.tensor(0)[k] = std::ldexp(static_cast<float>(ours.input().data()[k]), -net->tensors[0].exponent);
    ours_ms = std::min(ours_ms, thread_ms([&] { ours.run(one); }));
    floats_ms = std::min(floats_ms, thread_ms([&] { floats.run(); }));
    for (const NetOutput& output : net->outputs) {
      const Tensor16 got = ours.tensor(output.tensor);
      for (std::size_t k = 0; k < got.count(); ++k) {
        const double want = floats.tensor(output.tensor)[k];
        const double difference = std::ldexp(got.data()[k], -net->tensors[output.tensor].exponent) - want;
        squares[output.name].first += difference * difference;
        squares[output.name].second += want * want;
      }
    }
  }
  double worst = 0;
  for (const auto& [name, sums] : squares)
    if (net->tensors[net->output(name).value()].count() > 1) worst = std::max(worst, std::sqrt(sums.first / sums.second));
  std::printf("%s: ours %.2f ms, XNNPACK %.2f ms, %.2f times; deviation %.4f of an output at most\n", GetParam(), ours_ms,
              floats_ms, floats_ms / ours_ms, worst);
  EXPECT_LT(worst, 0.01);
#ifdef NDEBUG
  EXPECT_LE(ours_ms, floats_ms);
#endif
}

INSTANTIATE_TEST_SUITE_P(, BesideXnnpack,
                         testing::Values("person_detector", "body_lite", "body_full", "hand_lite", "hand_full"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace duo
