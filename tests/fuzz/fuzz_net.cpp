// Any bytes as a network's file: whole, and with a right hash behind the first 16, where a changed byte would end it at once. What is
// accepted is run when it is small.
#include <algorithm>
#include <cstdint>
#include <string>

#include "core/check.h"
#include "nets/net_file.h"
#include "nets/net_run.h"

namespace {

void read_and_run(std::string_view bytes) {
  const auto net = duo::parse_net(bytes, "fuzz");
  if (!net) {
    DUO_CHECK(net.error().what.find('\n') == std::string::npos);
    return;
  }
  std::size_t products = 0;
  for (const duo::NetLayer& layer : net->layers) {
    std::size_t per_value = 1;
    if (const auto* matmul = std::get_if<duo::Matmul16>(&layer.work)) per_value = static_cast<std::size_t>(matmul->inputs);
    products += net->tensors[layer.y].count() * std::max<std::size_t>(per_value, 27);
  }
  if (products > 1 << 20) return;
  duo::NetRun run(*net, duo::NetRun::Loops::kPlain);
  const duo::Tensor16 input = run.input();
  for (std::size_t i = 0; i < input.count(); ++i) {
    const duo::Range16 range = net->tensors[0].range;
    input.data()[i] = i % 3 == 0 ? range.low : range.high;
  }
  duo::Pool pool(1);
  run.run(pool);
  for (std::size_t i = 1; i < net->tensors.size(); ++i) run.tensor(static_cast<int>(i));
}

}  // namespace

int fuzz_net(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  read_and_run(bytes);
  if (size < 16) return 0;
  std::string body(bytes.substr(16));
  body.resize((body.size() + 7) / 8 * 8);
  const std::uint64_t hash = duo::hash_words(body);
  read_and_run("DUONET1\n" + std::string(reinterpret_cast<const char*>(&hash), sizeof(hash)) + body);
  return 0;
}
