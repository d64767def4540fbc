// duoptic batch: many recordings, on this machine or on a cluster.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "command.h"
#include "duoptic/interrupt.h"
#include "duoptic/reports.h"

namespace duo::app::batch {
namespace {

namespace fs = std::filesystem;

constexpr char kFooter[] =
    "plan finds recordings and writes OUT/manifest.jsonl, a line per task, to be read and edited. run works until all are\n"
    "done: by job arrays of Slurm where sbatch is, else by a pool of processes. Whatever is killed on the way, what lies in\n"
    "OUT/done is whole, and the same run again does what is missing. docs/batch.md shows a first night.\n\n"
    "Examples:\n"
    "  duoptic batch plan archive -o out --track                 each recording's people in 3D\n"
    "  duoptic batch plan archive -o out --depth --rig rig.json -- --fill --near 0.5\n"
    "  duoptic batch run out                                     all of it; Ctrl-C keeps what is done\n"
    "  duoptic batch run out --slurm --partition long --time 2:00:00 --mem 2G\n"
    "  duoptic batch status out --json\n"
    "  duoptic batch collect out                                 table.csv, table.json, links by name\n\n"
    "Exit codes of run: 0 all done; 3 all done, and inputs of some are cut; 4 some cannot be done because of their input;\n"
    "5 or 1 others are missing or tried too often, 130 or 143 stopped: the same run again goes on.";

struct Options {
  std::string archive, folder, key, partition, account, time, memory;
  bool track = false, depth = false, force = false, slurm = false, local = false, json = false, quiet = false;
  ArchiveWish wish;
  int jobs = 0, retries = RunSetup().retries, threads = 1;
  std::vector<std::string> sbatch;
};

BatchTool this_tool(const Options& options) {
  std::error_code error;
  return {.program = fs::read_symlink("/proc/self/exe", error), .version = DUO_VERSION, .threads = options.threads};
}

Result<Exit> plan(Options options, const CLI::App& app) {
  std::error_code error;
  if (fs::exists(fs::path(options.folder) / "manifest.jsonl", error) && !options.force)
    return Error{ErrorCode::kWriteFailed,
                 fmt::format("cannot plan into {}: it has a manifest already; edit that, or replace it with --force; results "
                             "whose inputs and options stay the same are kept",
                             options.folder)};
  if (fs::equivalent(options.archive, options.folder, error))
    throw CLI::ValidationError("-o", "the archive itself is no place for results; name another folder, also one in it");
  options.wish.command = options.depth ? "depth" : "track";
  if (!options.wish.rig.empty())
    if (const fs::path rig = fs::absolute(options.wish.rig, error); !error) options.wish.rig = rig.lexically_normal();
  DUO_TRY_ASSIGN(const ArchivePlan plan, plan_archive(options.archive, options.wish));
  if (plan.tasks.empty())
    return Error{ErrorCode::kNotFound, fmt::format("cannot plan {}: no two of its videos are a pair", options.archive)};
  DUO_TRY(write_manifest(options.folder, plan.tasks));
  const auto recordings = [&] {
    std::size_t count = 0;
    for (std::size_t i = 0; i < plan.tasks.size(); ++i) count += i == 0 || plan.tasks[i].id != plan.tasks[i - 1].id;
    return count;
  }();
  const auto without_rig = std::count_if(plan.tasks.begin(), plan.tasks.end(),
                                         [](const ArchiveTask& task) { return task.rig.empty() && task.inputs.size() == 2; });
  const fs::path manifest = fs::path(options.folder) / "manifest.jsonl";
  if (options.json)
    print_json({{"manifest", manifest.string()},
                {"recordings", recordings},
                {"tasks", plan.tasks.size()},
                {"without_rig", without_rig},
                {"left_out", plan.left_out}});
  else
    fmt::print("{}: {} recordings, {} tasks; next: duoptic batch run {}\n", manifest.string(), recordings, plan.tasks.size(),
               options.folder);
  for (const std::string& line : plan.left_out) say(app, "left out: " + line);
  if (without_rig > 0)
    say(app, fmt::format("warning: {} pairs of videos have no rig file near them; --rig names one", without_rig));
  return Exit::kOk;
}

void print(const Batch& batch, const BatchStatus& status, const Options& options) {
  if (options.json)
    fmt::print("{}\n", json_of(batch, status));
  else if (!options.quiet)
    fmt::print("{}", text_of(batch, status));
}

Exit exit_of(const BatchStatus& status) {
  if (!status.faults.empty()) return Exit::kUnexpected;
  bool output = false;
  for (const TaskStatus& task : status.tasks) output |= task.state == TaskState::kMissing && task.exit == 5;
  if (!status.whole()) return output ? Exit::kOutput : Exit::kUnexpected;
  if (status.failed > 0) return Exit::kInput;
  return status.cut > 0 ? Exit::kCut : Exit::kOk;
}

/// Over and over on a terminal, a line a minute elsewhere.
class Lines {
 public:
  Lines(const CLI::App& app, bool quiet) : app_(app), quiet_(quiet) {}
  ~Lines() { clear(); }
  void show(const std::string& text) {
    const auto now = std::chrono::steady_clock::now();
    if (quiet_ || (!terminal_ && now - last_ < std::chrono::minutes(1))) return;
    last_ = now;
    if (!terminal_) return say(app_, text);
    put_on_stderr("\r\033[K" + text);
    shown_ = true;
  }
  void clear() {
    if (std::exchange(shown_, false)) put_on_stderr("\r\033[K");
  }

 private:
  const CLI::App& app_;
  bool quiet_, terminal_ = isatty(STDERR_FILENO) != 0, shown_ = false;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

Result<Exit> run(const Options& options, const CLI::App& app) {
  Lines lines(app, options.quiet);
  std::int64_t bytes = 0;
  DUO_TRY_ASSIGN(
      const Batch batch, Batch::open(options.folder, DUO_VERSION, [&](std::int64_t read) {
        lines.show(fmt::format("reading inputs for the first time: {:.1f} GB", static_cast<double>(bytes += read) * 1e-9));
      }));
  RunSetup setup{.tool = this_tool(options), .jobs = options.jobs, .retries = options.retries, .sbatch = options.sbatch};
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) setup.sbatch.push_back(option + ("=" + value));
  };
  add("--partition", options.partition);
  add("--account", options.account);
  add("--time", options.time);
  add("--mem", options.memory);
  setup.stopped = [] { return Interrupt::asked(); };
  setup.progress = [&](const BatchStatus& status) { lines.show(line_of(status)); };
  setup.say = [&](const std::string& line) {
    lines.clear();
    say(app, line);
  };
  const bool on_slurm = options.slurm || (!options.local && has_slurm());
  DUO_TRY_ASSIGN(const BatchStatus status, on_slurm ? run_on_slurm(batch, setup) : run_here(batch, setup));
  lines.clear();
  print(batch, status, options);
  if (Interrupt::asked()) say(app, "stopped; the same run again goes on");
  return exit_of(status);
}

Result<Exit> status(const Options& options) {
  DUO_TRY_ASSIGN(const Batch batch, Batch::open(options.folder, DUO_VERSION));
  DUO_TRY_ASSIGN(const BatchStatus status, batch.status());
  print(batch, status, options);
  return Exit::kOk;
}

/// Stopped by a signal, it ends with the code of that: the task is still to be done.
Result<Exit> work(const Options& options, const CLI::App& app) {
  DUO_TRY_ASSIGN(const Worked worked,
                 work_on(options.folder, options.key, this_tool(options), [] { return Interrupt::asked(); }));
  if (!worked.what.empty()) say(app, worked.what);
  switch (worked.how) {
    case Worked::How::kDone:
      return worked.exit == 3 ? Exit::kCut : Exit::kOk;
    case Worked::How::kDoneBefore:
      return Exit::kOk;
    case Worked::How::kFailed:
      return worked.exit == 2 || worked.exit == 4 ? Exit::kInput : worked.exit == 5 ? Exit::kOutput : Exit::kUnexpected;
    case Worked::How::kStopped:
    case Worked::How::kDiffers:
      break;
  }
  return Exit::kUnexpected;
}

Result<Exit> collect_all(const Options& options) {
  DUO_TRY_ASSIGN(const Batch batch, Batch::open(options.folder, DUO_VERSION));
  DUO_TRY_ASSIGN(const auto files, collect(batch));
  if (options.json)
    print_json({{"json", files[0].string()}, {"csv", files[1].string()}});
  else
    fmt::print("{}\n{}\n", files[0].string(), files[1].string());
  return Exit::kOk;
}

void add_plan(CLI::App& sub, Options& options) {
  sub.add_option("ARCHIVE", options.archive, "Folder with recordings, also in folders below it")->required();
  sub.add_option("-o,--output", options.folder, "Folder for the manifest and the results, which all workers see")
      ->type_name("OUT")
      ->required();
  CLI::Option* track = sub.add_flag("--track", options.track, "People in 3D, a task per recording (the default)");
  sub.add_flag("--depth", options.depth, "Depth, a task per range of frames")->excludes(track);
  sub.add_option("--rig", options.wish.rig, "Rig of all recordings; without it the nearest rig file of each")
      ->check(CLI::ExistingFile);
  sub.add_option("--shard-frames", options.wish.shard_frames,
                 "Of depth: frames per task; without it some 45 s of work of one thread, 2000 of 640x480")
      ->type_name("N")
      ->check(within(std::int64_t{1}, std::int64_t{1} << 40));
  sub.add_option("ARGUMENTS", options.wish.arguments, "After --: further options of duoptic track or depth, for each task");
  sub.add_flag("--force", options.force, "Replace a manifest");
  sub.add_flag("--json", options.json, "Print the summary as JSON");
}

void add_run(CLI::App& sub, Options& options) {
  CLI::Option* slurm = sub.add_flag("--slurm", options.slurm, "By job arrays of Slurm (the default where sbatch is)");
  sub.add_flag("--local", options.local, "By processes of this machine")->excludes(slurm);
  sub.add_option("--jobs", options.jobs, "Tasks at once; without it one per core, on a cluster all")
      ->type_name("N")
      ->check(within(1, 100'000));
  sub.add_option("--retries", options.retries, "Further tries of what failed, but not by its input")
      ->type_name("N")
      ->check(within(0, 1000))
      ->capture_default_str();
  sub.add_option("--partition", options.partition, "Slurm: where to run")->type_name("P");
  sub.add_option("--account", options.account, "Slurm: who pays")->type_name("A");
  sub.add_option("--time", options.time, "Slurm: most time of a task")->type_name("T");
  sub.add_option("--mem", options.memory, "Slurm: memory of a task")->type_name("M");
  sub.add_option("--sbatch", options.sbatch, "Slurm: a further argument of sbatch, like --sbatch=--qos=low; may be repeated")
      ->type_name("ARGUMENT");
  sub.add_flag("--quiet", options.quiet, "No progress and no summary");
  sub.add_flag("--json", options.json, "Print the summary as JSON");
}

struct Subcommands {
  CLI::App *plan, *run, *status, *work, *collect;
};

Subcommands add_subcommands(CLI::App& batch, Options& options) {
  const Subcommands subs = {batch.add_subcommand("plan", "Find the recordings of an archive and write a manifest"),
                            batch.add_subcommand("run", "Work until all tasks of a manifest are done"),
                            batch.add_subcommand("status", "What is done, runs, failed and is missing"),
                            batch.add_subcommand("work", "One task: what a cluster's job or any other program runs"),
                            batch.add_subcommand("collect", "One table of all recordings, and links to results by name")};
  add_plan(*subs.plan, options);
  for (CLI::App* sub : {subs.run, subs.status, subs.work, subs.collect})
    sub->add_option("OUT", options.folder, "Folder of the manifest")->required();
  add_run(*subs.run, options);
  subs.work->add_option("KEY", options.key, "Key of the task")->required();
  for (CLI::App* sub : {subs.run, subs.work})
    sub->add_option("--threads", options.threads, "Threads of each task; results do not depend on them")
        ->check(within(1, 256))
        ->capture_default_str();
  for (CLI::App* sub : {subs.status, subs.collect}) sub->add_flag("--json", options.json, "Print it as JSON");
  for (CLI::App* sub : {subs.plan, subs.run, subs.status, subs.work, subs.collect}) sub->footer(kFooter);
  return subs;
}

}  // namespace

Command add(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("batch", "Many recordings, on this machine or on a cluster");
  sub->require_subcommand(1);
  sub->footer(kFooter);
  const auto options = std::make_shared<Options>();
  const Subcommands subs = add_subcommands(*sub, *options);
  return {sub, [options, sub, subs]() -> Result<Exit> {
            if (subs.plan->parsed()) return plan(*options, *sub);
            if (subs.run->parsed()) return run(*options, *sub);
            if (subs.status->parsed()) return status(*options);
            if (subs.work->parsed()) return work(*options, *sub);
            return collect_all(*options);
          }};
}

}  // namespace duo::app::batch
