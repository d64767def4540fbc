#include <utility>

#include "duoptic/source.h"

namespace duo {
namespace {

class WithSkew final : public PairSource {
 public:
  WithSkew(std::unique_ptr<PairSource> pairs, TimeNs skew_ns) : pairs_(std::move(pairs)), skew_ns_(skew_ns) {}
  Size size() const override { return pairs_->size(); }
  std::int64_t count() const override { return pairs_->count(); }
  bool still() const override { return pairs_->still(); }
  double frame_s() const override { return pairs_->frame_s(); }
  std::optional<Rig> rig() const override { return pairs_->rig(); }
  bool live() const override { return pairs_->live(); }
  std::int64_t dropped() const override { return pairs_->dropped(); }
  std::string warning() const override { return pairs_->warning(); }

  Result<Next> next(Pair& into) override {
    DUO_TRY_ASSIGN(const Next next, pairs_->next(into));
    if (next == Next::kNew) into.right.t_ns += skew_ns_;
    return next;
  }

 private:
  std::unique_ptr<PairSource> pairs_;
  TimeNs skew_ns_;
};

}  // namespace

std::unique_ptr<PairSource> with_skew(std::unique_ptr<PairSource> pairs, TimeNs skew_ns) {
  return std::make_unique<WithSkew>(std::move(pairs), skew_ns);
}

}  // namespace duo
