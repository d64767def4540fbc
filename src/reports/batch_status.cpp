#include <fmt/format.h>

#include "duoptic/reports.h"
#include "reports/report_json.h"

namespace duo {

std::string json_of(const Batch& batch, const BatchStatus& status) {
  nlohmann::json hosts = nlohmann::json::object(), failures = nlohmann::json::array(), cut = failures, running = failures;
  for (const auto& [name, host] : status.hosts)
    hosts[name] = {{"tasks", host.tasks},
                   {"frames", host.frames},
                   {"frames_per_s", host.seconds > 0 ? static_cast<double>(host.frames) / host.seconds : 0}};
  for (std::size_t i = 0; i < status.tasks.size(); ++i) {
    const TaskStatus& task = status.tasks[i];
    const ArchiveTask& of = batch.tasks()[i];
    if (task.state == TaskState::kRunning) running.push_back(of.id);
    if (task.state == TaskState::kDone && task.exit == 3) cut.push_back(of.id);
    if (task.state != TaskState::kDone && task.failures > 0)
      failures.push_back({{"id", of.id},
                          {"key", of.key},
                          {"exit", task.exit},
                          {"tries", task.failures},
                          {"for_good", task.state == TaskState::kFailed},
                          {"host", task.host},
                          {"what", task.what}});
  }
  const nlohmann::json slowest = status.slowest ? nlohmann::json{{"id", batch.tasks()[*status.slowest].id},
                                                                 {"seconds", status.tasks[*status.slowest].seconds}}
                                                : nlohmann::json();
  return json_text({{"tasks", status.tasks.size()},
                    {"done", status.done},
                    {"cut", cut},
                    {"running", running},
                    {"failed", status.failed},
                    {"missing", status.missing},
                    {"failures", failures},
                    {"faults", status.faults},
                    {"hosts", hosts},
                    {"left_s", status.left_s ? nlohmann::json(*status.left_s) : nlohmann::json()},
                    {"slowest", slowest}});
}

std::string line_of(const BatchStatus& status) {
  std::string text = fmt::format("{} of {} done", status.done, status.tasks.size());
  if (status.cut > 0) text += fmt::format(" ({} cut)", status.cut);
  if (status.running > 0) text += fmt::format(", {} running", status.running);
  if (status.failed > 0) text += fmt::format(", {} failed", status.failed);
  if (status.missing > 0) text += fmt::format(", {} missing", status.missing);
  const bool goes_on = status.running > 0 || status.missing > 0;
  if (goes_on && status.left_s) text += fmt::format(", about {:.0f} min left", *status.left_s / 60 + 0.5);
  return text;
}

std::string text_of(const Batch& batch, const BatchStatus& status) {
  std::string text = line_of(status) + "\n";
  for (const auto& [name, host] : status.hosts)
    if (host.seconds > 0)
      text += fmt::format("{}: {} tasks, {} frames, {:.1f} frames/s of each worker\n", name, host.tasks, host.frames,
                          static_cast<double>(host.frames) / host.seconds);
  if (status.slowest)
    text += fmt::format("slowest: {}, {:.1f} s\n", batch.tasks()[*status.slowest].id, status.tasks[*status.slowest].seconds);
  for (std::size_t i = 0; i < status.tasks.size(); ++i) {
    const TaskStatus& task = status.tasks[i];
    if (task.state == TaskState::kDone && task.exit == 3) text += fmt::format("cut: {}\n", batch.tasks()[i].id);
    if (task.state != TaskState::kDone && task.failures > 0)
      text += fmt::format("{}{}\n", task.state == TaskState::kFailed ? "failed: " : "not done: ", task.what);
  }
  for (const std::string& fault : status.faults) text += fmt::format("fault: {}\n", fault);
  return text;
}

}  // namespace duo
