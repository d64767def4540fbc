#include <algorithm>

#include "detectors/place.h"
#include "duoptic/detector.h"

namespace duo {
namespace {

constexpr std::uint16_t kHalf = 16384;  // a probability of 0.5
constexpr std::uint16_t kSure = 21299;  // 0.65: who is new has to be surer than who is followed
constexpr int kLooks = 4;               // at what was found

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

/// Four times the torso's centre.
PointQ8 four_centres(const SeenBody& body) {
  using enum BodyPoint;
  return sum_of(body, {kLeftShoulder, kRightShoulder, kLeftHip, kRightHip});
}

std::int64_t square(std::int64_t x, std::int64_t y) { return x * x + y * y; }

/// Whether the torso moved by less than 1/50 of half the region between two looks, and is there in the second.
bool rests(const SeenBody& first, const SeenBody& second) {
  const PointQ8 a = four_centres(first), b = four_centres(second);
  const std::int64_t half = half_side(second.next);
  return second.score_q15 >= kSure && 156 * square(a.x - b.x, a.y - b.y) < half * half;
}

/// Two bodies whose torsos' centres are less than half a torso apart are one.
bool same_body(const SeenBody& a, const SeenBody& b) {
  using enum BodyPoint;
  const auto torso = [](const SeenBody& body) {
    const PointQ8 up = sum_of(body, {kLeftShoulder, kRightShoulder}), down = sum_of(body, {kLeftHip, kRightHip});
    return square(up.x - down.x, up.y - down.y);  // four times the square of its length
  };
  const PointQ8 ca = four_centres(a), cb = four_centres(b);
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
  std::vector<TurnedSquare> regions;
  std::vector<SeenBody> bodies, before, kept;
  std::vector<SeenHand> hands;
  std::vector<std::optional<SeenHand>*> owners;  // of each of them
  std::vector<SeenPerson> people;
  std::int64_t picture = 0, searches = 0;  // how many

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
      const auto same =
          std::ranges::find_if(finds, [&](const FoundPerson& other) { return same_find(found.region, other.region); });
      if (same == finds.end())
        finds.push_back(found);
      else if (same->score_q15 < found.score_q15)
        *same = found;
    }
  }

  /// Looks at what was found and then where each look says to look next: a person's region comes to rest, what is made up of
  /// parts of several people wanders. Leaves those that rest in `bodies`.
  void settle(View<const Rgb8> picture_now) {
    regions.clear();
    for (const FoundPerson& found : finds) regions.push_back(found.region);
    for (int i = 0; i < kLooks; ++i) {
      before.swap(bodies);
      look_at(picture_now);
      for (std::size_t k = 0; k < bodies.size(); ++k) regions[k] = bodies[k].next;
    }
    std::size_t kept_count = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i)
      if (rests(before[i], bodies[i])) bodies[kept_count++] = bodies[i];
    bodies.resize(kept_count);
  }

  /// Looks at `regions`.
  void look_at(View<const Rgb8> picture_now) {
    looks.clear();
    for (const TurnedSquare& region : regions) looks.push_back({picture_now, region});
    bodies.resize(looks.size());
    detector.bodies(looks, bodies);
  }

  /// Adds the bodies that are there to those kept, each once: of two that are one the surer.
  void keep() {
    for (const SeenBody& body : bodies) {
      if (body.score_q15 < kHalf) continue;
      const auto other = std::ranges::find_if(kept, [&](const SeenBody& each) { return same_body(body, each); });
      if (other == kept.end())
        kept.push_back(body);
      else if (other->score_q15 < body.score_q15)
        *other = body;
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
    owners.clear();
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
  std::ranges::sort(m.finds, [](const FoundPerson& a, const FoundPerson& b) { return a.score_q15 > b.score_q15; });
  m.settle(picture);
  m.keep();
  return m.finish(picture);
}

std::span<const SeenPerson> PeopleFinder::follow(View<const Rgb8> picture, std::span<const TurnedSquare> also) {
  Memory& m = *memory_;
  m.begin(picture);
  m.kept.clear();
  m.regions.clear();
  for (const SeenPerson& person : m.people) m.regions.push_back(person.body.next);
  m.regions.insert(m.regions.end(), also.begin(), also.end());
  m.look_at(picture);
  m.keep();
  constexpr int kSearchAgain = 3;  // pictures, for somebody who was there
  const bool missed = !also.empty() && m.picture % kSearchAgain == 0;
  const bool next = m.picture % m.options.search_every == 0 || m.kept.empty();
  ++m.picture;
  if (missed || next) {
    m.finds.clear();
    if (next) m.search(picture, m.parts[static_cast<std::size_t>(m.searches++) % m.parts.size()]);
    if (missed) m.search(picture, m.parts.front());
    std::erase_if(m.finds, [&](const FoundPerson& found) {
      return std::ranges::any_of(m.kept, [&](const SeenBody& body) { return same_find(body.next, found.region); });
    });
    m.settle(picture);
    m.keep();
  }
  return m.finish(picture);
}

}  // namespace duo
