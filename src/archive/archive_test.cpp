// What a plan finds, the manifest's round trip, keys, and what a folder's bytes say of tasks.
#include "duoptic/archive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "archive/layout.h"
#include "archive/sha256.h"
#include "archive/summarize.h"
#include "duoptic/recording.h"
#include "duoptic/synthetic.h"
#include "tests/write_media.h"

namespace duo {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::TempFolder;

void put(const fs::path& path, std::string_view bytes = "none") {
  fs::create_directories(path.parent_path());
  test::put(path, bytes);
}

TEST(Sha256, PublishedExamples) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  const TempFolder folder;
  put(folder / "million", std::string(1'000'000, 'a'));  // more than a block is read at once
  EXPECT_EQ(*sha256_of(folder / "million", true), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  EXPECT_FALSE(sha256_of(folder / "nothing"));
}

TEST(PlanArchive, PairsRecordingsAndTheirRigs) {
  const TempFolder folder;
  const fs::path archive = folder / "archive";
  for (const char* name : {"rig.json",
                           "monday/p01_left.avi",
                           "monday/p01_right.avi",
                           "monday/p02-Left.MP4",
                           "monday/p02-Right.MP4",
                           "monday/notes.txt",
                           "tuesday/rig.yml",
                           "tuesday/a/left.avi",
                           "tuesday/a/right.avi",
                           "tuesday/b_l.mov",
                           "tuesday/b_r.mov",
                           "tuesday/b_rig.json",
                           "sides/left/c.avi",
                           "sides/right/c.avi",
                           "both.mp4",
                           "alone_left.avi",
                           ".hidden/x_left.avi",
                           ".hidden/x_right.avi",
                           "bright.avi",
                           "earlier/manifest.jsonl",
                           "earlier/done/k/depth.mkv"})
    put(archive / name);
  const auto plan = plan_archive(archive, {.arguments = {"--model", "lite"}});
  ASSERT_TRUE(plan) << plan.error().what;
  struct Want {
    std::string id;
    std::vector<std::string> inputs;
    std::string rig;
  };
  const fs::path at = fs::canonical(archive);
  const auto in = [&](const char* name) { return (at / name).string(); };
  const std::vector<Want> want = {{"both", {in("both.mp4")}, in("rig.json")},
                                  {"bright", {in("bright.avi")}, in("rig.json")},  // no word that says a side
                                  {"monday/p01", {in("monday/p01_left.avi"), in("monday/p01_right.avi")}, in("rig.json")},
                                  {"monday/p02", {in("monday/p02-Left.MP4"), in("monday/p02-Right.MP4")}, in("rig.json")},
                                  {"sides/c", {in("sides/left/c.avi"), in("sides/right/c.avi")}, in("rig.json")},
                                  {"tuesday/a", {in("tuesday/a/left.avi"), in("tuesday/a/right.avi")}, in("tuesday/rig.yml")},
                                  {"tuesday/b", {in("tuesday/b_l.mov"), in("tuesday/b_r.mov")}, in("tuesday/b_rig.json")}};
  ASSERT_EQ(plan->tasks.size(), want.size());
  for (std::size_t i = 0; i < want.size(); ++i) {
    EXPECT_EQ(plan->tasks[i].id, want[i].id);
    EXPECT_EQ(plan->tasks[i].inputs, want[i].inputs);
    EXPECT_EQ(plan->tasks[i].rig, want[i].rig) << want[i].id;
    EXPECT_EQ(plan->tasks[i].arguments, (std::vector<std::string>{"--model", "lite", "--engine", "simd"}));
  }
  ASSERT_EQ(plan->left_out.size(), 1u);
  EXPECT_NE(plan->left_out[0].find("alone_left.avi"), std::string::npos);
  EXPECT_EQ(plan_archive(folder / "nowhere", {}).error().code, ErrorCode::kNotFound);
  fs::create_directories(folder / "empty");
  EXPECT_NE(plan_archive(folder / "empty", {}).error().what.find("no video"), std::string::npos);
}

TEST(PlanArchive, NamesThatAManifestCannotHoldAndLinksThatNobodyCanFollow) {
  const TempFolder folder;
  const fs::path archive = folder / "archive";
  for (const char* name : {"a.mkv", "caf\xe9.mkv"}) put(archive / name);
  for (const char* name : {"a_rig.json", "rig.json"}) fs::create_symlink(name, archive / name);  // to itself
  const auto plan = plan_archive(archive, {});
  ASSERT_TRUE(plan) << plan.error().what;
  ASSERT_EQ(plan->tasks.size(), 1u);
  EXPECT_EQ(plan->tasks[0].rig, "");
  ASSERT_EQ(plan->left_out.size(), 1u);
  EXPECT_NE(plan->left_out[0].find("no UTF-8"), std::string::npos) << plan->left_out[0];
  EXPECT_NE(plan_archive(archive, {.rig = "\xff.json"}).error().what.find("no UTF-8"), std::string::npos);
  fs::rename(archive, folder / "\xe9t\xe9");
  EXPECT_NE(plan_archive(folder / "\xe9t\xe9", {}).error().what.find("no UTF-8"), std::string::npos);
}

TEST(PlanArchive, DepthByRangesThatMeet) {
  const TempFolder folder;
  const fs::path archive = folder / "archive";
  fs::create_directories(archive);
  const SyntheticPair raw = render_synthetic({.size = {64, 48}}, 1);
  auto recorder = Recorder::open(archive / "clip.mkv", {.frame_s = 1.0 / 30, .rig = raw.rig});
  ASSERT_TRUE(recorder);
  for (int i = 0; i < 25; ++i) {
    Pair pair;
    pair.left.pixels = raw.pair.left.pixels.clone();
    pair.right.pixels = raw.pair.right.pixels.clone();
    pair.left.t_ns = pair.right.t_ns = TimeNs{i} * 33'333'333;
    ASSERT_TRUE(recorder->write(pair));
  }
  ASSERT_TRUE(recorder->finish());
  put(archive / "rig.json");  // the recording's own is taken
  const auto plan = plan_archive(archive, {.command = "depth", .shard_frames = 10});
  ASSERT_TRUE(plan);
  ASSERT_EQ(plan->tasks.size(), 3u);
  EXPECT_EQ(plan->tasks[0].rig, "");
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(plan->tasks[static_cast<std::size_t>(i)].begin, 10 * i);
    EXPECT_EQ(plan->tasks[static_cast<std::size_t>(i)].end, i < 2 ? 10 * (i + 1) : 0);  // to the end, whatever was announced
  }
  EXPECT_EQ(plan_archive(archive, {.command = "depth"})->tasks.size(), 1u);
  EXPECT_EQ(plan_archive(archive, {.command = "depth", .shard_frames = 20})->tasks.size(), 1u);  // no task of a rest
}

TEST(Manifest, ComesBackAndSaysWhichLineIsWrong) {
  const TempFolder folder;
  const ArchiveTask track{
      .id = "a \"b\"\nc", .inputs = {"/x/l.avi", "/x/r.avi"}, .rig = "/x/rig.json", .arguments = {"--set", "a=1"}};
  const ArchiveTask depth{.id = "d", .inputs = {"/x/both.mkv"}, .command = "depth", .begin = 3000, .end = 6000};
  ASSERT_TRUE(write_manifest(folder / "out", {track, depth}));
  const auto back = read_manifest(folder / "out");
  ASSERT_TRUE(back) << back.error().what;
  ASSERT_EQ(back->size(), 2u);
  EXPECT_EQ(to_json((*back)[0]), to_json(track));
  EXPECT_EQ(to_json((*back)[1]), to_json(depth));
  const std::string good = bytes_of(folder / "out/manifest.jsonl");
  for (const std::string bad :
       {"{", "[]", R"({"id":"","inputs":["a"],"command":"track"})", R"({"id":"a","inputs":[],"command":"track"})",
        R"({"id":"a","inputs":["a","b","c"],"command":"track"})", R"({"id":"a","inputs":["a"],"command":"rm"})",
        R"({"id":"a","inputs":["a"],"command":"track","arguments":"x"})",
        R"({"id":"a","inputs":["a"],"command":"depth","frames":[5,5]})",
        R"({"id":"a","inputs":["a"],"command":"depth","frames":[-1,5]})",
        R"({"id":"a","inputs":["a"],"command":"track","frames":[0,5]})"}) {
    put(folder / "out/manifest.jsonl", good + bad + "\n");
    const auto read = read_manifest(folder / "out");
    ASSERT_FALSE(read) << bad;
    EXPECT_NE(read.error().what.find("line 3 of"), std::string::npos) << read.error().what;
    EXPECT_EQ(read.error().what.find('\n'), std::string::npos);
  }
}

TEST(Batch, KeysFollowContentsArgumentsAndVersion) {
  const TempFolder folder;
  put(folder / "l.avi", "left");
  put(folder / "r.avi", "right");
  put(folder / "rig.json", "rig");
  const ArchiveTask task{.id = "a", .inputs = {folder / "l.avi", folder / "r.avi"}, .rig = folder / "rig.json"};
  const auto key = [&](const ArchiveTask& of, const std::string& version = "1") {
    EXPECT_TRUE(write_manifest(folder / "out", {of}));
    const auto batch = Batch::open(folder / "out", version);
    EXPECT_TRUE(batch);
    return batch->tasks()[0].key;
  };
  const std::string first = key(task);
  EXPECT_EQ(first.size(), kKeyLetters);
  EXPECT_EQ(key(task), first);
  ArchiveTask renamed = task;
  renamed.id = "b";
  EXPECT_EQ(key(renamed), first);
  ArchiveTask other = task;
  other.arguments = {"--fill"};
  EXPECT_NE(key(other), first);
  EXPECT_NE(key(task, "2"), first);
  const auto time = fs::last_write_time(folder / "rig.json");
  put(folder / "rig.json", "RIG");
  fs::last_write_time(folder / "rig.json", time + std::chrono::seconds(1));
  const std::string changed = key(task);
  EXPECT_NE(changed, first);
  put(folder / "rig.json", "rig");  // by its content
  fs::last_write_time(folder / "rig.json", time + std::chrono::seconds(2));
  EXPECT_EQ(key(task), first);
  // Hashes are kept by path, size and time: who fakes all three is believed.
  put(folder / "rig.json", "RIG");
  fs::last_write_time(folder / "rig.json", time + std::chrono::seconds(2));
  EXPECT_EQ(key(task), first);
  fs::remove(folder / "rig.json");
  EXPECT_NE(key(task), first);
}

TEST(Batch, EveryTaskIsFoundByItsKey) {
  const TempFolder folder;
  std::vector<ArchiveTask> tasks;
  for (int i = 0; i < 100; ++i) {
    const fs::path path = folder / (std::string(static_cast<std::size_t>(i % 7) * 40, 'x') + std::to_string(i));
    put(path, std::to_string(i));
    tasks.push_back({.id = std::to_string(i), .inputs = {path}});
  }
  ASSERT_TRUE(write_manifest(folder / "out", tasks));
  const auto batch = Batch::open(folder / "out", "1");
  ASSERT_TRUE(batch);
  for (const ArchiveTask& task : batch->tasks()) {
    const auto found = find_task(folder / "out", task.key);
    ASSERT_TRUE(found) << found.error().what;
    EXPECT_EQ(found->id, task.id);
    EXPECT_EQ(found->key, task.key);
  }
  for (const std::string& none :
       {std::string(kKeyLetters, '0'), std::string(kKeyLetters, 'z'), std::string(), std::string("a b")})
    EXPECT_TRUE(find_task(folder / "out", none)->inputs.empty()) << none;
}

/// Records and signs of life as workers leave them; what is half there is never taken for done.
TEST(Batch, StatusIsWhatTheFolderSays) {
  const TempFolder folder;
  std::vector<ArchiveTask> tasks;
  for (int i = 0; i < 8; ++i) {
    put(folder / std::to_string(i), std::to_string(i));
    tasks.push_back({.id = std::to_string(i), .inputs = {folder / std::to_string(i)}});
  }
  const fs::path out = folder / "out";
  ASSERT_TRUE(write_manifest(out, tasks));
  const auto batch = Batch::open(out, "1");
  ASSERT_TRUE(batch);
  const auto key = [&](std::size_t i) { return batch->tasks()[i].key; };
  put(out / "done" / key(0) / "done.json", R"({"exit":0,"host":"h","seconds":2.0,"frames":60})");
  put(out / "done" / key(1) / "done.json", R"({"exit":3,"host":"h","seconds":4.0,"frames":60})");
  put(out / "done" / key(2) / "people.jsonl");                   // no record
  put(out / "done" / key(3) / "done.json", R"({"exit":0,"ho)");  // half a record
  put(out / "failed" / (key(4) + ".a.json"), R"({"exit":1,"what":"no memory","host":"h"})");
  put(out / "failed" / (key(5) + ".a.json"), R"({"exit":4,"what":"no video","host":"h"})");
  put(out / "failed" / (key(5) + ".b.json"), R"({"exit":1,"what":"no memory","host":"h"})");
  const std::string living = worker_name(key(6)), dead = worker_name(key(7)).insert(kKeyLetters + 14, "99"),
                    elsewhere = key(4) + ".elsewhere.1.2.x";  // `dead`: a process that there is not
  for (const std::string& name : {living, dead, elsewhere}) fs::create_directories(out / "work" / name / "results");
  const auto status = batch->status();
  ASSERT_TRUE(status);
  const std::vector<TaskState> want = {TaskState::kDone,    TaskState::kDone,   TaskState::kMissing, TaskState::kMissing,
                                       TaskState::kRunning, TaskState::kFailed, TaskState::kRunning, TaskState::kMissing};
  for (std::size_t i = 0; i < want.size(); ++i) EXPECT_EQ(status->tasks[i].state, want[i]) << i;
  EXPECT_EQ(status->done, 2);
  EXPECT_EQ(status->cut, 1);
  EXPECT_EQ(status->hosts.at("h").frames, 120);
  EXPECT_EQ(*status->slowest, 1u);
  EXPECT_EQ(status->tasks[5].what, "no video");
  EXPECT_EQ(status->tasks[5].failures, 2);
  // Another machine's worker that has touched nothing for long is dead.
  fs::last_write_time(out / "work" / elsewhere, fs::file_time_type::clock::now() - std::chrono::minutes(2));
  EXPECT_EQ(batch->status()->tasks[4].state, TaskState::kMissing);
  batch->sweep();
  EXPECT_TRUE(fs::exists(out / "work" / living));
  EXPECT_FALSE(fs::exists(out / "work" / dead) || fs::exists(out / "work" / elsewhere));
  // A record is read once; results that are taken away are missing at once.
  put(out / "done" / key(0) / "done.json", "");
  EXPECT_EQ(batch->status()->done, 2);
  EXPECT_EQ(Batch::open(out, "1")->status()->done, 1);
  fs::remove_all(out / "done" / key(0));
  EXPECT_EQ(batch->status()->done, 1);
}

TEST(Summarize, CountsStatesOfJoints) {
  const TempFolder folder;
  put(folder / "people.jsonl",
      "{\"type\":\"header\"}\n"
      R"({"type":"frame","people":[{"joints":{"left_hand":{"state":"seen"},"left_elbow":{"state":"lost"}}}]})"
      "\n"
      R"({"type":"frame","people":[{"joints":{"left_hand":{"state":"inferred"}}},{"joints":{"left_hand":{"state":"seen"}}}]})"
      "\n"
      R"({"type":"frame","people":[]})"
      "\n");
  const nlohmann::json got = summarize_tracks(folder / "people.jsonl");
  EXPECT_EQ(got["frames"], 3);
  EXPECT_EQ(got["people"], 3);
  EXPECT_EQ(got["joints"]["left_hand"], (nlohmann::json{{"seen", 2}, {"inferred", 1}, {"lost", 0}}));
  EXPECT_EQ(got["joints"]["left_elbow"], (nlohmann::json{{"seen", 0}, {"inferred", 0}, {"lost", 1}}));
  put(folder / "said.json", R"({"frames":7,"coverage_percent":42.5,"rig_fit":{"verdict":"poor"}})");
  EXPECT_EQ(summarize_depth(folder / "said.json"),
            (nlohmann::json{{"frames", 7}, {"coverage_percent", 42.5}, {"rig", "poor"}}));
  put(folder / "said.json", "no JSON");
  EXPECT_TRUE(summarize_depth(folder / "said.json").is_null());
}

}  // namespace
}  // namespace duo
