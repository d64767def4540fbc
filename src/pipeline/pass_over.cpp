#include "pipeline/pass_over.h"

#include <utility>

namespace duo {

Result<FrameStream::Passed> pass_over(FilePairs& files, const FrameStream::Choice& choice, RigWatch& watch, std::string& news) {
  FrameStream::Passed passed;
  while (passed.pairs < choice.first) {
    if (passed.pairs > 0 && watch.settled() && passed.pairs < choice.first - 1) {
      DUO_TRY_ASSIGN(const std::uint64_t reached, files.pass_to(static_cast<std::uint64_t>(choice.first - 1)));
      passed.pairs = static_cast<std::int64_t>(reached);
    }
    auto pair = std::make_shared<Pair>();
    DUO_TRY_ASSIGN(const Next next, files.next(*pair));
    if (next != Next::kNew) break;
    if (passed.pairs == 0) passed.start_ns = pair->left.t_ns;
    const bool looked_at = (choice.first - passed.pairs) % choice.every == 0;
    if (const RigFit* const found = looked_at ? watch.see(pair, false) : nullptr) news = found->what;
    passed.last = std::move(pair);
    ++passed.pairs;
  }
  return passed;
}

}  // namespace duo
