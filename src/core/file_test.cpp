// Files under attack: what others do to names while we write harms neither their files nor ours.
#include "core/file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <utility>

namespace duo {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
 protected:
  Files() {
    std::string name = (fs::temp_directory_path() / "duoptic_file_XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  ~Files() override { fs::remove_all(folder_); }
  std::set<std::string> names() const {
    std::set<std::string> out;
    for (const auto& entry : fs::directory_iterator(folder_)) out.insert(entry.path().filename());
    return out;
  }
  static std::string content(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static void put(const fs::path& path, std::string_view bytes) { std::ofstream(path, std::ios::binary) << bytes; }
  fs::path folder_;
};

TEST_F(Files, AFileThatWaitsAtAGuessedNameIsNotWrittenInto) {
  put(folder_ / "precious", "precious");
  fs::create_hard_link(folder_ / "precious", folder_ / (".a.txt." + std::to_string(getpid()) + ".partial"));
  ASSERT_TRUE(write_file(folder_ / "a.txt", "new"));
  EXPECT_EQ(content(folder_ / "a.txt"), "new");
  EXPECT_EQ(content(folder_ / "precious"), "precious");
}

TEST_F(Files, OfTwoWritersTheLaterOneWinsWhole) {
  auto first = PartialFile::open(folder_ / "a.txt"), second = PartialFile::open(folder_ / "a.txt");
  ASSERT_TRUE(first && second);
  ASSERT_TRUE(first->write("the first one's") && second->write("second's") && first->write(" words"));
  ASSERT_TRUE(first->publish());
  EXPECT_EQ(content(folder_ / "a.txt"), "the first one's words");
  ASSERT_TRUE(second->publish());
  EXPECT_EQ(content(folder_ / "a.txt"), "second's");
  EXPECT_EQ(names(), std::set<std::string>{"a.txt"});
}

TEST_F(Files, AFolderPutInThePlaceOfOursIsNotWrittenInto) {
  fs::create_directory(folder_ / "ours");
  fs::create_directory(folder_ / "theirs");
  put(folder_ / "theirs/a.txt", "precious");
  auto file = PartialFile::open(folder_ / "ours/a.txt");
  ASSERT_TRUE(file && file->write("new"));
  fs::rename(folder_ / "ours", folder_ / "moved");
  fs::create_directory_symlink(folder_ / "theirs", folder_ / "ours");
  ASSERT_TRUE(file->publish());
  EXPECT_EQ(content(folder_ / "theirs/a.txt"), "precious");
  EXPECT_EQ(content(folder_ / "moved/a.txt"), "new");
}

TEST_F(Files, NothingOfOthersIsRemoved) {
  std::string hidden;
  {
    const auto file = PartialFile::open(folder_ / "a.txt");
    ASSERT_TRUE(file);
    hidden = *names().begin();
    fs::remove(folder_ / hidden);
    put(folder_ / hidden, "theirs");
  }
  EXPECT_EQ(content(folder_ / hidden), "theirs");
}

TEST_F(Files, ALinkIsReplacedNotFollowed) {
  put(folder_ / "precious", "precious");
  fs::create_symlink(folder_ / "precious", folder_ / "a.txt");
  ASSERT_TRUE(write_file(folder_ / "a.txt", "new"));
  EXPECT_EQ(content(folder_ / "precious"), "precious");
  EXPECT_EQ(content(folder_ / "a.txt"), "new");
  EXPECT_FALSE(fs::is_symlink(folder_ / "a.txt"));
}

TEST_F(Files, NewOnesHaveTheModeThatTheUmaskGives) {
  const mode_t before = umask(027);
  ASSERT_TRUE(write_file(folder_ / "a.txt", "new"));
  umask(before);
  struct stat there {};
  ASSERT_EQ(stat((folder_ / "a.txt").c_str(), &there), 0);
  EXPECT_EQ(there.st_mode & 0777U, 0640U);
  EXPECT_EQ(there.st_uid, geteuid());
}

TEST_F(Files, ANameThatIsToBeKeptIsKept) {
  auto file = PartialFile::open(folder_ / "a.txt");
  ASSERT_TRUE(file && file->write("new"));
  put(folder_ / "a.txt", "precious");
  const auto taken = file->take_name(PartialFile::Earlier::kKeep);
  ASSERT_FALSE(taken);
  EXPECT_EQ(content(folder_ / "a.txt"), "precious");
  ASSERT_TRUE(file->take_name(PartialFile::Earlier::kReplace));
  ASSERT_TRUE(file->write(" words"));  // it stays open
  ASSERT_TRUE(file->publish());
  EXPECT_EQ(content(folder_ / "a.txt"), "new words");
  EXPECT_EQ(names(), std::set<std::string>{"a.txt"});
}

TEST_F(Files, ALargeOneIsRefusedUnread) {
  const fs::path path = folder_ / "large";
  put(path, "");
  fs::resize_file(path, std::uintmax_t{40} << 30);  // holes: takes no room
  const auto refused = read_file(path, std::size_t{1} << 20, "picture");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("it has more than 1048576 bytes"), std::string::npos) << refused.error().what;
}

TEST_F(Files, WhatIsNoFileIsNotRead) {
  const fs::path fifo = folder_ / "fifo";
  ASSERT_EQ(mkfifo(fifo.c_str(), 0600), 0);
  for (const fs::path& path : {fifo, folder_, fs::path("/dev/zero")}) {
    const auto read = read_file(path, 1 << 20, "rig");
    ASSERT_FALSE(read) << path;
    EXPECT_EQ(read.error().code, ErrorCode::kBadInput);
    EXPECT_NE(read.error().what.find(path.string()), std::string::npos);
  }
}

}  // namespace
}  // namespace duo
