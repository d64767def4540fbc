#include "duoptic/peers.h"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace duo {
namespace {

using Kind = Peer::Kind;
constexpr Peer kBmUsual{
    .name = "BM usual", .kind = Kind::kBm, .block = 15, .cap = 31, .uniqueness = 10, .speckle = 100, .texture = 10};
constexpr Peer kBmTuned{
    .name = "BM tuned", .kind = Kind::kBm, .block = 7, .cap = 15, .uniqueness = 2, .speckle = 50, .padded = true};

constexpr Peer sgbm_usual(const char* name, Kind kind) {
  return {.name = name, .kind = kind, .block = 5, .cap = 63, .uniqueness = 10, .speckle = 100, .p1 = 8 * 25, .p2 = 32 * 25};
}
constexpr Peer kAccuracy[] = {
    kBmUsual,
    kBmTuned,
    sgbm_usual("SGBM usual", Kind::kSgbm),
    {.name = "SGBM tuned",
     .kind = Kind::kSgbm,
     .block = 1,
     .cap = 63,
     .uniqueness = 0,
     .speckle = 100,
     .p1 = 10,
     .p2 = 12,
     .padded = true},
    sgbm_usual("3WAY usual", Kind::k3Way),
    {.name = "3WAY tuned",
     .kind = Kind::k3Way,
     .block = 1,
     .cap = 15,
     .uniqueness = 10,
     .speckle = 100,
     .p1 = 8,
     .p2 = 16,
     .padded = true},
    {.name = "HH4 tuned",
     .kind = Kind::kHh4,
     .block = 1,
     .cap = 15,
     .uniqueness = 10,
     .speckle = 100,
     .p1 = 12,
     .p2 = 20,
     .padded = true},
};
constexpr Peer kSpeed[] = {kBmUsual, sgbm_usual("3WAY usual", Kind::k3Way), sgbm_usual("HH4 usual", Kind::kHh4),
                           sgbm_usual("HH usual", Kind::kHh)};

cv::Ptr<cv::StereoMatcher> make_matcher(const Peer& peer, int disparities) {
  constexpr int kSpeckleRange = 2, kLeftRight = 1;
  if (peer.kind == Kind::kBm) {
    auto bm = cv::StereoBM::create(disparities, peer.block);
    bm->setPreFilterCap(peer.cap);
    bm->setTextureThreshold(peer.texture);
    bm->setUniquenessRatio(peer.uniqueness);
    bm->setSpeckleWindowSize(peer.speckle);
    bm->setSpeckleRange(kSpeckleRange);
    bm->setDisp12MaxDiff(kLeftRight);
    return bm;
  }
  const int mode = peer.kind == Kind::k3Way  ? cv::StereoSGBM::MODE_SGBM_3WAY
                   : peer.kind == Kind::kHh4 ? cv::StereoSGBM::MODE_HH4
                   : peer.kind == Kind::kHh  ? cv::StereoSGBM::MODE_HH
                                             : cv::StereoSGBM::MODE_SGBM;
  return cv::StereoSGBM::create(0, disparities, peer.block, peer.p1, peer.p2, kLeftRight, peer.cap, peer.uniqueness,
                                peer.speckle, kSpeckleRange, mode);
}

cv::Mat widened(View<const std::uint8_t> view, int columns) {
  const cv::Mat mat(view.height(), view.width(), CV_8U, const_cast<std::uint8_t*>(view.data()),
                    static_cast<std::size_t>(view.stride()));
  cv::Mat out;
  cv::copyMakeBorder(mat, out, 0, 0, columns, 0, cv::BORDER_REPLICATE);
  return out;
}

}  // namespace

std::span<const Peer> accuracy_peers() { return kAccuracy; }
std::span<const Peer> speed_peers() { return kSpeed; }

struct PeerMatcher::State {
  int padding;
  cv::Mat left, right, d_q4;
  cv::Ptr<cv::StereoMatcher> matcher;
};

PeerMatcher::PeerMatcher(const Peer& peer, View<const std::uint8_t> left, View<const std::uint8_t> right, int max_disparity) {
  const int disparities = (max_disparity + 15) / 16 * 16, padding = peer.padded ? disparities : 0;
  state_.reset(new State{padding, widened(left, padding), widened(right, padding), {}, make_matcher(peer, disparities)});
}

PeerMatcher::PeerMatcher(PeerMatcher&&) noexcept = default;
PeerMatcher::~PeerMatcher() = default;

void PeerMatcher::run(int threads) {
  cv::setNumThreads(threads);
  state_->matcher->compute(state_->left, state_->right, state_->d_q4);
}

Image<float> PeerMatcher::disparity_px() const {
  Image<float> out({state_->left.cols - state_->padding, state_->left.rows});
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const std::int16_t d_q4 = state_->d_q4.at<std::int16_t>(y, x + state_->padding);
      out.at(y, x) = d_q4 <= 0 ? -1.0f : static_cast<float>(d_q4) / 16.0f;
    }
  return out;
}

Image<std::uint8_t> opencv_gray(View<const Rgb8> color) {
  const cv::Mat rgb(color.height(), color.width(), CV_8UC3, const_cast<Rgb8*>(color.data()),
                    static_cast<std::size_t>(color.stride()) * sizeof(Rgb8));
  Image<std::uint8_t> out(color.size());
  cv::Mat gray(out.height(), out.width(), CV_8U, out.row(0), static_cast<std::size_t>(out.stride()));
  cv::cvtColor(rgb, gray, cv::COLOR_RGB2GRAY);
  return out;
}

std::string opencv_version() { return cv::getVersionString(); }

}  // namespace duo
