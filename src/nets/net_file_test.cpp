#include "nets/net_file.h"

#include "nets/net_run.h"
#include "tests/agree.h"
#include "tests/net_bytes.h"

namespace duo {
namespace {

using test::NetBytes;
using test::small_net;

void expect_refused(const NetBytes& net, const std::string& why) {
  const auto read = parse_net(net.bytes(), "made.net");
  ASSERT_FALSE(read) << why;
  EXPECT_NE(read.error().what.find(why), std::string::npos) << read.error().what;
  EXPECT_EQ(read.error().what.find('\n'), std::string::npos);
  EXPECT_EQ(read.error().code, ErrorCode::kBadInput);
}

// By hand: red 1 + 2 + 3 + 4 = 10, green of the middle pixel (0, 0) 7; (2 * 10 - 3 * 7 + 1) >> 1 = 0; with red 20: (40 - 21 +
// 1) >> 1 = 10, added to itself 20.
TEST(NetFile, ReadsAndRunsASmallNetwork) {
  const auto net = parse_net(small_net().bytes(), "made.net");
  ASSERT_TRUE(net) << net.error().what;
  EXPECT_EQ(net->name, "small");
  EXPECT_EQ(net->output("sum"), 3);
  EXPECT_FALSE(net->output("other"));
  Pool pool(1);
  NetRun run(*net, NetRun::Loops::kPlain);
  const std::int16_t pixels[] = {1, 7, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0};
  for (const auto& [red, sum] : {std::pair{1, 0}, std::pair{11, 20}}) {
    std::copy(std::begin(pixels), std::end(pixels), run.input().data());
    run.input().data()[0] = static_cast<std::int16_t>(red);
    run.run(pool);
    EXPECT_EQ(run.tensor(3).data()[0], sum);
  }
}

TEST(NetFile, EveryCutAndEveryChangedByteIsRefused) {
  const std::string whole = small_net().bytes();
  for (std::size_t size = 0; size < whole.size(); ++size) EXPECT_FALSE(parse_net(whole.substr(0, size), "cut.net")) << size;
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string changed = whole;
    changed[at] ^= 4;
    EXPECT_FALSE(parse_net(changed, "changed.net")) << at;
  }
  EXPECT_FALSE(parse_net(whole + "12345678", "longer.net"));
}

// With a right hash, as somebody who means harm would write it: the file is cut anywhere in its body.
TEST(NetFile, EveryCutWithARightHashIsRefused) {
  const std::string body = small_net().body();
  for (std::size_t size = 0; size + 8 < body.size(); ++size)
    EXPECT_FALSE(parse_net(NetBytes::close(body.substr(0, size)), "cut.net")) << size;
}

TEST(NetFile, WhatCannotBeRunIsRefused) {
  NetBytes net = small_net();
  net.layers[1].a = 2;
  expect_refused(net, "layer 1 is not one that can be run");
  net = small_net();
  net.layers[2].b = 3;
  expect_refused(net, "layer 2 is not one that can be run");
  net = small_net();
  net.layers[0].kind = 8;
  expect_refused(net, "layer 0 is not one that can be run");
  net = small_net();
  net.layers[1].at += 8;
  expect_refused(net, "outside the file");
  net = small_net();
  net.layers[1].at = 0xFFFFFFF8;
  expect_refused(net, "outside the file");
  net = small_net();
  net.tensors[1].height = 0;
  expect_refused(net, "no size");
  net = small_net();
  net.tensors[0] = {65535, 65535, 65535};
  expect_refused(net, "no size");
  net = small_net();
  net.tensors[0].width = 4;
  expect_refused(net, "sizes do not fit");
  net = small_net();
  net.tensors[0].low = 1;
  expect_refused(net, "range lacks 0");
  net = small_net();
  net.layers[2].left_a = 15;
  expect_refused(net, "shifts are too large");
  net = small_net();
  net.outputs[0].second = 4;
  expect_refused(net, "no layer's result");
}

TEST(NetFile, SumsThatMayOverflowAreRefused) {
  NetBytes net = small_net();
  net.layers[1].at = net.add({32767, 32767}, {200000}, {1});
  expect_refused(net, "do not fit 32 bits");
  net.layers[1].at = net.add({32767, 32767}, {100000}, {1});
  EXPECT_TRUE(parse_net(net.bytes(), "made.net"));
  net.layers[1].at = net.add({-32768, 0}, {0}, {1});
  expect_refused(net, "-32768");
  net.layers[1].at = net.add({1, 0}, {0}, {32});
  expect_refused(net, "shift is above 31");
}

TEST(NetFile, AMissingFileSaysSo) {
  const auto net = read_net("nowhere/body.net");
  ASSERT_FALSE(net);
  EXPECT_EQ(net.error().code, ErrorCode::kNotFound);
  EXPECT_NE(net.error().what.find("nowhere/body.net"), std::string::npos);
}

/// A network of layers on tensors of these sizes; layer i reads tensor a[i], and b[i] where that is not -1, and writes tensor i
/// + 1.
Net chained(std::vector<Size> sizes, std::vector<LayerWork> works, const std::vector<int>& a, const std::vector<int>& b,
            int channels = 32) {
  Net net;
  for (const Size& size : sizes) net.tensors.push_back({size, channels, 0, {}});
  for (std::size_t i = 0; i < works.size(); ++i)
    net.layers.push_back({std::move(works[i]), a[i], b[i], static_cast<int>(i) + 1});
  net.outputs.push_back({"out", static_cast<int>(works.size())});
  return net;
}

// Windows and other sizes begin a chain, products and sums of single pixels go on, one row of pixels stands for itself.
TEST(MemoryPlan, LayersOfSinglePixelsGoOnWithTheirChain) {
  const Size large{8, 8}, small{4, 4}, one{1, 1};
  std::vector<LayerWork> works = {Depthwise16{}, Matmul16{}, Add16{}, Depthwise16{}, Matmul16{}, Matmul16{}, Matmul16{}};
  const Net net = chained({large, large, large, large, small, small, one, one}, std::move(works), {0, 1, 2, 3, 4, 5, 6},
                          {-1, -1, 0, -1, -1, -1, -1});
  EXPECT_EQ(chains_of(net), (std::vector<int>{0, 0, 0, 1, 1, 2, 3}));
}

// Of few rows with many channels a thread makes its channels: windows and sums go on, products need those of all threads.
TEST(MemoryPlan, LayersOfSingleChannelsGoOnWithTheirChain) {
  const Size few{7, 7}, many{9, 8};
  std::vector<LayerWork> works = {Matmul16{}, Depthwise16{}, Matmul16{}, Add16{}, Matmul16{}, Depthwise16{}};
  EXPECT_EQ(chains_of(chained(std::vector(7, few), works, {0, 1, 2, 3, 4, 5}, {-1, -1, -1, 0, -1, -1}, 112)),
            (std::vector<int>{0, 0, 1, 1, 2, 2}));
  EXPECT_EQ(chains_of(chained(std::vector(7, many), works, {0, 1, 2, 3, 4, 5}, {-1, -1, -1, 0, -1, -1}, 112)),
            (std::vector<int>{0, 1, 1, 1, 1, 2}));
  // Averages of the channels go on, too; what is read of another size was made by rows.
  works = {Depthwise16{}, SumPixels16{}, Matmul16{}};
  EXPECT_EQ(chains_of(chained({many, few, {1, 1}, {1, 1}}, works, {0, 1, 2}, {-1, -1, -1}, 112)), (std::vector<int>{0, 0, 1}));
}

// A thread may write the product of its rows while another still reads what the windows read: so three tensors lie apart,
// though no layer needs more than two.
TEST(MemoryPlan, TensorsOfAChainLieApart) {
  const Size size{8, 8};
  const MemoryPlan plan = plan_memory(chained({size, size, size}, {Depthwise16{}, Matmul16{}}, {0, 1}, {-1, -1}));
  EXPECT_EQ(plan.count, 3u * 8 * 8 * 32);
  const MemoryPlan windows = plan_memory(chained({size, size, size}, {Depthwise16{}, Depthwise16{}}, {0, 1}, {-1, -1}));
  EXPECT_EQ(windows.count, 2u * 8 * 8 * 32);
}

// No tensor's memory is another's while both are needed; by hand for the small network: input 12 and results 2, 1 and 1 values,
// each in blocks of 32: the last two layers are a chain, whose three tensors lie apart; the input may share with its results.
TEST(MemoryPlan, TensorsThatAreNeededTogetherLieApart) {
  const auto net = parse_net(small_net().bytes(), "made.net");
  ASSERT_TRUE(net);
  const MemoryPlan plan = plan_memory(*net);
  EXPECT_NE(plan.offsets[0], plan.offsets[1]);
  EXPECT_NE(plan.offsets[1], plan.offsets[2]);
  EXPECT_NE(plan.offsets[1], plan.offsets[3]);
  EXPECT_NE(plan.offsets[2], plan.offsets[3]);
  EXPECT_EQ(plan.count, 96u);
}

}  // namespace
}  // namespace duo
