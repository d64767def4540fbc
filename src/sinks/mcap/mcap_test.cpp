// MCAP files by a strict reader of their own records, messages by hand.
#include <gtest/gtest.h>

#include <cstring>
#include <map>

#include "duoptic/sink.h"
#include "sinks/mcap/cdr.h"
#include "tests/arm_poses.h"
#include "tests/write_media.h"

namespace duo {
namespace {

using namespace test;  // NOLINT: the poses

/// Numbers at a place that moves on.
struct McapCursor {
  std::string_view bytes;
  template <class T>
  T take() {
    T value{};
    EXPECT_GE(bytes.size(), sizeof(T));
    std::memcpy(&value, bytes.data(), std::min(sizeof(T), bytes.size()));
    bytes.remove_prefix(std::min(sizeof(T), bytes.size()));
    return value;
  }
  std::string_view take_bytes(std::size_t count) {
    EXPECT_GE(bytes.size(), count);
    const std::string_view out = bytes.substr(0, count);
    bytes.remove_prefix(std::min(count, bytes.size()));
    return out;
  }
  std::string_view text() { return take_bytes(take<std::uint32_t>()); }
  /// Operation code and content.
  std::pair<int, McapCursor> record() {
    const int op = take<std::uint8_t>();
    return {op, {take_bytes(take<std::uint64_t>())}};
  }
};

/// The messages of a file by topic, and what its index says.
struct McapRead {
  std::map<std::string, std::vector<std::string>> messages;
  std::map<std::string, std::string> types;
  std::vector<std::uint64_t> times_ns;
  std::uint64_t counted = 0;

  explicit McapRead(const std::string& file) {
    const std::string_view magic("\x89MCAP0\r\n", 8);
    EXPECT_EQ(file.substr(0, 8), magic);
    EXPECT_EQ(file.substr(file.size() - 8), magic);
    McapCursor all{std::string_view(file).substr(8, file.size() - 16)};
    while (!all.bytes.empty()) {
      const std::size_t at = file.size() - 8 - all.bytes.size();
      auto [op, content] = all.record();
      if (op == 6) {  // a chunk
        chunk_at_.push_back(at);
        content.take_bytes(28);
        EXPECT_EQ(content.text(), "");
        McapCursor records{content.take_bytes(content.take<std::uint64_t>())};
        while (!records.bytes.empty()) see(records.record());
        EXPECT_TRUE(content.bytes.empty());
      } else if (op == 8) {  // its index
        content.take_bytes(16);
        EXPECT_EQ(content.take<std::uint64_t>(), chunk_at_.at(indexed_++));
      } else if (op == 11) {
        counted = content.take<std::uint64_t>();
      }
    }
    EXPECT_EQ(indexed_, chunk_at_.size());
  }

 private:
  void see(std::pair<int, McapCursor> record) {
    auto& [op, content] = record;
    const auto id = content.take<std::uint16_t>();
    if (op == 3) {
      schemas_[id] = content.text();
      EXPECT_EQ(content.text(), "ros2msg");
    } else if (op == 4) {
      const auto schema = content.take<std::uint16_t>();
      topics_[id] = content.text();
      types[topics_[id]] = schemas_.at(schema);
      EXPECT_EQ(content.text(), "cdr");
    } else if (op == 5) {
      EXPECT_EQ(content.take<std::uint32_t>(), messages[topics_.at(id)].size());
      times_ns.push_back(content.take<std::uint64_t>());
      EXPECT_EQ(content.take<std::uint64_t>(), times_ns.back());
      messages[topics_[id]].emplace_back(content.bytes);
    }
  }

  std::map<int, std::string> schemas_, topics_;
  std::vector<std::size_t> chunk_at_;
  std::size_t indexed_ = 0;
};

TEST(Cdr, FieldsLieAtMultiplesOfTheirSize) {
  Cdr cdr;
  cdr.put(std::uint8_t{7}).put(std::uint32_t{0x01020304}).text("ab").put(1.0);
  EXPECT_EQ(cdr.bytes(), std::string("\0\1\0\0"            // little-endian
                                     "\7\0\0\0\4\3\2\1"    // three bytes between
                                     "\3\0\0\0ab\0"        // with its end
                                     "\0\0\0\0\0\0\0"  // 15 bytes so far: one between; a double
                                     "\xF0\x3F",
                                     4 + 8 + 7 + 1 + 8));
}

TEST(Mcap, MessagesByHand) {
  const test::TempFolder folder;
  TrackHeader header;
  header.rectified = {{.focal_px = 100, .cx_px = 0, .cy_px = 0, .baseline_m = 0.1}, {2, 1}, {}, {}};
  Instant instant;
  instant.frame.disparity.d_q4 = Image<std::uint16_t>({2, 1});
  instant.frame.disparity.d_q4.at(0, 0) = Disparity::kNone;
  instant.frame.disparity.d_q4.at(0, 1) = 5 * 16;  // 2 m
  instant.frame.color = Image<Rgb8>({2, 1});
  instant.frame.color.at(0, 1) = {1, 2, 3};
  instant.people = {arm_of({0.5, -0.25, 1.5}, {0, 0, 2}, {1, 2, 3})};
  instant.people[0].joints[kElbow].state = JointState::kLost;
  auto sink = make_mcap(folder / "people.mcap", header);
  ASSERT_TRUE(sink) << sink.error().what;
  EXPECT_TRUE((*sink)->wants_pictures());
  ASSERT_TRUE((*sink)->write(instant.tracked(0)));
  ASSERT_TRUE((*sink)->write(instant.tracked(45)));
  EXPECT_FALSE(std::filesystem::exists(folder / "people.mcap"));
  ASSERT_TRUE((*sink)->finish());

  const McapRead file(bytes_of(folder / "people.mcap"));
  EXPECT_EQ(file.counted, 10u);
  EXPECT_EQ(file.times_ns,
            (std::vector<std::uint64_t>{0, 0, 0, 0, 0, 1500000000, 1500000000, 1500000000, 1500000000, 1500000000}));
  ASSERT_EQ(file.types.size(), 5u);
  EXPECT_EQ(file.types.at("/tf"), "tf2_msgs/msg/TFMessage");

  // A head of four bytes; a time, a name of 13 bytes in 16; then the message's own.
  const std::string& image = file.messages.at("/duoptic/depth/image").at(1);
  McapCursor fields{std::string_view(image).substr(4)};
  EXPECT_EQ(fields.take<std::int32_t>(), 1);
  EXPECT_EQ(fields.take<std::uint32_t>(), 500000000u);
  EXPECT_EQ(fields.text(), std::string_view("duoptic_left", 13));
  fields.take_bytes(3);
  EXPECT_EQ(fields.take<std::uint32_t>(), 1u);
  EXPECT_EQ(fields.take<std::uint32_t>(), 2u);
  EXPECT_EQ(fields.text(), std::string_view("32FC1", 6));
  EXPECT_EQ(fields.take<std::uint8_t>(), 0);
  fields.take_bytes(1);
  EXPECT_EQ(fields.take<std::uint32_t>(), 8u);
  EXPECT_EQ(fields.take<std::uint32_t>(), 8u);
  EXPECT_TRUE(std::isnan(fields.take<float>()));
  EXPECT_EQ(fields.take<float>(), 2.0F);
  EXPECT_TRUE(fields.bytes.empty());

  // The last 17 bytes are one point and whether it is one.
  const std::string& cloud = file.messages.at("/duoptic/points").at(0);
  McapCursor point{std::string_view(cloud).substr(cloud.size() - 17)};
  EXPECT_EQ(point.take<float>(), 0.02F);
  EXPECT_EQ(point.take<float>(), 0.0F);
  EXPECT_EQ(point.take<float>(), 2.0F);
  EXPECT_EQ(point.take<std::uint32_t>(), 0x010203u);
  EXPECT_EQ(point.take<std::uint8_t>(), 1);

  // The elbow is lost: two transforms, of which the last ends in the hand's place and no turn.
  const std::string& transforms = file.messages.at("/tf").at(0);
  EXPECT_EQ(McapCursor{std::string_view(transforms).substr(4)}.take<std::uint32_t>(), 2u);
  EXPECT_EQ(transforms.find("right_elbow"), std::string::npos);
  EXPECT_NE(transforms.find("person_1/right_hand"), std::string::npos);
  McapCursor last{std::string_view(transforms).substr(transforms.size() - 56)};
  for (const double want : {1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0}) EXPECT_EQ(last.take<double>(), want);
}

}  // namespace
}  // namespace duo
