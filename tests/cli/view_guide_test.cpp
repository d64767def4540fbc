// From nothing to an avatar that moves: `duoptic view` alone, a clip is chosen, its board calibrates the cameras, the person in
// it is tracked, and another program hears of the bones.
#include <lo/lo.h>

#include <atomic>
#include <fstream>

#include "duoptic/calibration_guide.h"
#include "sinks/clip/avi.h"
#include "tests/guided_poses.h"
#include "view_window.h"

namespace duo::window_test {
namespace {

constexpr Size kClipSize = {480, 360};
constexpr int kRate_hz = 10, kPicturesHeld = 7;

/// A person waves; then somebody holds a board at every place that the guide asks for, 0.7 s each.
void film(const fs::path& left_file, const fs::path& right_file, Rig& rig) {
  const Result<Board> board = largest_board("chessboard:9x6", *parse_paper("a4"));  // as the window assumes
  ASSERT_TRUE(board);
  auto person = SyntheticClip::open({.size = kClipSize, .script = "wave"}, 2);
  ASSERT_TRUE(person);
  rig = person->rig();
  auto left = AviWriter::open(left_file, kClipSize, kRate_hz, 92), right = AviWriter::open(right_file, kClipSize, kRate_hz, 92);
  ASSERT_TRUE(left && right);
  for (int i = 0; i < 12; ++i) {
    const Pair pair = person->frame(i).pair;
    ASSERT_TRUE(left->write(pair.left.pixels) && right->write(pair.right.pixels));
  }
  for (std::size_t wish = 0; wish < kBoardWishes; ++wish) {
    const Pair pair =
        test::draw(*board, rig, test::guided_pose(static_cast<BoardWish>(wish), *board, rig), static_cast<unsigned>(wish));
    for (int i = 0; i < kPicturesHeld; ++i) ASSERT_TRUE(left->write(pair.left.pixels) && right->write(pair.right.pixels));
  }
  ASSERT_TRUE(left->finish() && right->finish());
}

/// A program that shows an avatar: liblo's server on a port that was free.
class Avatar {
 public:
  Avatar() : server_(lo_server_thread_new(nullptr, nullptr)) {
    lo_server_thread_add_method(server_, "/VMC/Ext/Bone/Pos", "sfffffff", &take, this);
    lo_server_thread_start(server_);
  }
  ~Avatar() { lo_server_thread_free(server_); }
  std::string target() const { return "127.0.0.1:" + std::to_string(lo_server_thread_get_port(server_)); }
  int bones() const { return bones_; }

 private:
  static int take(const char*, const char*, lo_arg**, int, lo_message, void* self) {
    ++static_cast<Avatar*>(self)->bones_;
    return 0;
  }
  lo_server_thread server_;
  std::atomic<int> bones_ = 0;
};

TEST_F(Running, FromNothingToAnAvatar) {
  Rig rig;
  film(at("board_left.avi"), at("board_right.avi"), rig);
  fs::create_directories(at("cache/duoptic"));
  std::ofstream(at("cache/duoptic/recent"))
      << at("board_left.avi").string() << "\t" << at("board_right.avi").string() << "\t\n";
  fs::remove(at("rig.json"));
  Avatar avatar;
  start("--model lite --vmc " + avatar.target());
  wait_for_title("choose a source");
  press("2");  // the first is the rendered person
  wait_for_title("the rig is found");
  constexpr Rgb8 kSaveButton = {36, 92, 150};
  for (const Size size : {Size{640, 480}, Size{1280, 800}, Size{1920, 1080}}) {
    told(fmt::format("xdotool windowsize {} {} {}", window_, size.width, size.height));
    Image<Rgb8> shown;
    EXPECT_TRUE(waited([&] { return (shown = screenshot()).size() == size; }));
    EXPECT_GT(near(shown, size.width * 3 / 4.0, size.height * 3 / 4.0, size.height / 4, kSaveButton), 500) << size.width;
  }
  press("Return");
  wait_for_title("tracking");
  EXPECT_TRUE(waited([&] { return avatar.bones() > 0; }));
  press("q");
  expect_end(0);
  EXPECT_EQ(bytes_of(at("view_err.txt")), "");

  const auto found = load_rig(at("rig.json"));
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_NEAR(found->baseline_m(), rig.baseline_m(), 4 * found->uncertainty->baseline_m + 1e-4);
  EXPECT_LT(found->reprojection_rms_px, 0.3);
  EXPECT_NE(bytes_of(at("rig_report.html")).find("Calibration report"), std::string::npos);
  EXPECT_NE(bytes_of(at("cache/duoptic/recent")).find("\t" + at("rig.json").string() + "\n"), std::string::npos);
}

/// Two pictures that move on while nothing is found; the window is left without a rig.
TEST_F(Running, WithoutARigItAsksForABoard) {
  start("left.mp4 right.mp4");
  wait_for_title("no more pictures");
  EXPECT_EQ(screenshot().size(), (Size{1440, 860}));
  press("q");
  expect_end(0);
}

}  // namespace
}  // namespace duo::window_test
