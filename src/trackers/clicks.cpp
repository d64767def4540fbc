#include "duoptic/clicks.h"

#include <fmt/format.h>

#include <algorithm>

namespace duo {

Clicks::Clicks(std::vector<const Skeleton*> skeletons, bool wanted) : skeletons_(std::move(skeletons)) {
  for (const Skeleton* skeleton : skeletons_) {
    const Side side = skeleton->joints[0].side;
    choices_.emplace_back(side == Side::kRight ? "right" : side == Side::kLeft ? "left" : skeleton->name);
  }
  if (skeletons_.size() == 2) choices_.emplace_back("both");
  start(0);
  wanted_ = wanted;
}

void Clicks::start(std::size_t choice) {
  choice_ = choice;
  clicks_.clear();
  asked_.clear();
  for (std::size_t s = 0; s < skeletons_.size(); ++s)
    if (s == choice || choice >= skeletons_.size())
      for (std::size_t j = skeletons_[s]->joints.size(); j-- > 0;) asked_.push_back(&skeletons_[s]->joints[j]);
  wanted_ = true;
}

bool Clicks::joined(std::size_t click) const {
  if (click == 0) return false;
  const JointDef *here = asked_[click], *before = asked_[click - 1];
  return std::any_of(skeletons_.begin(), skeletons_.end(), [&](const Skeleton* skeleton) {
    const auto index = skeleton->index_of(here->id);
    return index && skeleton->index_of(before->id) && before->parent == static_cast<int>(*index);
  });
}

bool Clicks::add(double x_px, double y_px) {
  clicks_.push_back({asked_[clicks_.size()]->id, x_px, y_px});
  return clicks_.size() == asked_.size();
}

std::string Clicks::prompt() const {
  const std::size_t next = clicks_.size();
  if (next >= asked_.size()) return "";
  std::string name(asked_[next]->name);
  std::replace(name.begin(), name.end(), '_', ' ');
  return fmt::format("Click the {} ({} of {})", name, next + 1, asked_.size());
}

std::vector<Selection> Clicks::selections() const {
  std::vector<Selection> out;
  for (const Skeleton* skeleton : skeletons_) {
    Selection selection{skeleton, {}};
    for (const Click& click : clicks_)
      if (skeleton->index_of(click.joint)) selection.clicks.push_back(click);
    if (!selection.clicks.empty()) out.push_back(std::move(selection));
  }
  return out;
}

}  // namespace duo
