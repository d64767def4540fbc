#include <algorithm>

#include "detectors/place.h"
#include "duoptic/detector.h"

namespace duo {
namespace {

constexpr std::uint16_t kHalf = 16384;  // a probability of 0.5
constexpr int kSearchEvery = 4;         // pictures, while somebody is followed

/// The whole picture first, then squares of 0.6 of its shorter side that overlap by a half: people too small for the whole.
std::vector<Window> parts_of(Size size) {
  std::vector<Window> parts = {Window::all(size)};
  const int side = std::max(std::min(size.width, size.height) * 3 / 5, 1);
  const auto count = [&](int length) { return (length - side + side / 2) / std::max(side / 2, 1) + 1; };
  const int rows = count(size.height), columns = count(size.width);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j)
      parts.push_back(
          {(size.width - side) * j / std::max(columns - 1, 1), (size.height - side) * i / std::max(rows - 1, 1), side, side});
  return parts;
}

/// Sums of two or four points, so that nothing is rounded.
PointQ8 sum_of(const SeenBody& body, std::initializer_list<BodyPoint> points) {
  PointQ8 sum;
  for (const BodyPoint point : points) {
    sum.x += body.at(point).x_q8;
    sum.y += body.at(point).y_q8;
  }
  return sum;
}

std::int64_t square(std::int64_t x, std::int64_t y) { return x * x + y * y; }

/// Two bodies whose torsos' centres are less than half a torso apart are one.
bool same_body(const SeenBody& a, const SeenBody& b) {
  using enum BodyPoint;
  const auto centre = [](const SeenBody& body) { return sum_of(body, {kLeftShoulder, kRightShoulder, kLeftHip, kRightHip}); };
  const auto torso = [](const SeenBody& body) {
    const PointQ8 up = sum_of(body, {kLeftShoulder, kRightShoulder}), down = sum_of(body, {kLeftHip, kRightHip});
    return square(up.x - down.x, up.y - down.y);  // four times the square of its length
  };
  const PointQ8 ca = centre(a), cb = centre(b);  // four times
  return square(ca.x - cb.x, ca.y - cb.y) < std::max(torso(a), torso(b));
}

/// Two finds of one person: hips nearer than a quarter of the smaller region's half, sizes within twice.
bool same_find(const TurnedSquare& a, const TurnedSquare& b) {
  const std::int64_t ha = half_side(a), hb = half_side(b), least = std::min(ha, hb);
  return 16 * square(a.x_q8 - b.x_q8, a.y_q8 - b.y_q8) < least * least && std::max(ha, hb) < 2 * least;
}

Window box_of(const SeenBody& body, Size size) {
  std::int32_t x0 = 0, x1 = 0, y0 = 0, y1 = 0;
  bool any = false;
  const bool seen = std::ranges::any_of(body.points, [](const SeenPoint& point) { return point.visible_q15 >= kHalf; });
  for (const SeenPoint& point : body.points) {
    if (seen && point.visible_q15 < kHalf) continue;
    x0 = any ? std::min(x0, point.x_q8) : point.x_q8;
    x1 = any ? std::max(x1, point.x_q8) : point.x_q8;
    y0 = any ? std::min(y0, point.y_q8) : point.y_q8;
    y1 = any ? std::max(y1, point.y_q8) : point.y_q8;
    any = true;
  }
  return Window{x0 >> 8, y0 >> 8, (x1 >> 8) - (x0 >> 8) + 1, (y1 >> 8) - (y0 >> 8) + 1}.within(size);
}

}  // namespace

struct PeopleFinder::Memory {
  Memory(Detector& with, const Options& asked) : detector(with), options(asked) {}

  Detector& detector;
  Options options;
  Size size;
  std::vector<Window> parts;
  std::vector<FoundPerson> finds;
  std::vector<Look> looks;
  std::vector<SeenBody> bodies, kept;
  std::vector<SeenHand> hands;
  std::vector<SeenPerson> people;
  std::int64_t picture = 0, searches = 0;

  void begin(View<const Rgb8> picture_now) {
    if (!(picture_now.size() == size)) {
      size = picture_now.size();
      parts = parts_of(size);
      people.clear();
    }
  }

  /// Adds who is found in a part and is no one of before; of one person the surest find stays.
  void search(View<const Rgb8> picture_now, const Window& part) {
    for (const FoundPerson& found : detector.find(picture_now, part)) {
      const auto before =
          std::ranges::find_if(finds, [&](const FoundPerson& other) { return same_find(found.region, other.region); });
      if (before == finds.end())
        finds.push_back(found);
      else if (before->score_q15 < found.score_q15)
        *before = found;
    }
  }

  void look_at(View<const Rgb8> picture_now, std::span<const TurnedSquare> regions) {
    looks.clear();
    for (const TurnedSquare& region : regions) looks.push_back({picture_now, region});
    bodies.resize(looks.size());
    detector.bodies(looks, bodies);
  }

  /// Keeps the bodies that are there, each once: of two that are one the surer, earlier ones first.
  void keep() {
    for (const SeenBody& body : bodies) {
      if (body.score_q15 < kHalf) continue;
      const auto before = std::ranges::find_if(kept, [&](const SeenBody& other) { return same_body(body, other); });
      if (before == kept.end())
        kept.push_back(body);
      else if (before->score_q15 < body.score_q15)
        *before = body;
    }
    if (kept.size() > options.most) kept.resize(options.most);
  }

  std::span<const SeenPerson> finish(View<const Rgb8> picture_now) {
    people.clear();
    for (const SeenBody& body : kept) people.push_back({body, {}, {}, box_of(body, size)});
    if (options.hands && detector.sees_hands()) add_hands(picture_now);
    return people;
  }

  void add_hands(View<const Rgb8> picture_now) {
    looks.clear();
    std::vector<std::optional<SeenHand>*> owners;
    for (SeenPerson& person : people)
      for (const bool left : {true, false})
        if (const auto region = hand_region(person.body, left, size)) {
          looks.push_back({picture_now, *region});
          owners.push_back(left ? &person.left_hand : &person.right_hand);
        }
    hands.resize(looks.size());
    detector.hands(looks, hands);
    for (std::size_t i = 0; i < owners.size(); ++i)
      if (hands[i].score_q15 >= kHalf) *owners[i] = hands[i];
  }
};

PeopleFinder::PeopleFinder(Detector& detector, const Options& options) : memory_(std::make_unique<Memory>(detector, options)) {}
PeopleFinder::~PeopleFinder() = default;

std::span<const SeenPerson> PeopleFinder::look(View<const Rgb8> picture) {
  Memory& m = *memory_;
  m.begin(picture);
  m.finds.clear();
  m.kept.clear();
  for (const Window& part : m.parts) m.search(picture, part);
  std::ranges::stable_sort(m.finds, std::greater{}, &FoundPerson::score_q15);
  std::vector<TurnedSquare> regions;
  for (const FoundPerson& found : m.finds) regions.push_back(found.region);
  m.look_at(picture, regions);
  // The body's own region is better than the detector's.
  regions.clear();
  for (const SeenBody& body : m.bodies)
    if (body.score_q15 >= kHalf) regions.push_back(body.next);
  m.look_at(picture, regions);
  m.keep();
  return m.finish(picture);
}

std::span<const SeenPerson> PeopleFinder::follow(View<const Rgb8> picture) {
  Memory& m = *memory_;
  m.begin(picture);
  m.kept.clear();
  std::vector<TurnedSquare> regions;
  for (const SeenPerson& person : m.people) regions.push_back(person.body.next);
  m.look_at(picture, regions);
  m.keep();
  if (m.picture++ % kSearchEvery == 0 || m.kept.empty()) {
    m.finds.clear();
    m.search(picture, m.parts[static_cast<std::size_t>(m.searches++) % m.parts.size()]);
    regions.clear();
    for (const FoundPerson& found : m.finds)
      if (std::ranges::none_of(m.kept, [&](const SeenBody& body) { return same_find(body.next, found.region); }))
        regions.push_back(found.region);
    m.look_at(picture, regions);
    m.keep();
  }
  return m.finish(picture);
}

}  // namespace duo
