#pragma once
#include <algorithm>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "renderer/base/clock.hpp"
#include "renderer/base/result.hpp"
#include "renderer/base/stage_time.hpp"
#include "renderer/techniques/work_rate.hpp"

namespace limn {

struct TechniqueContext;

/// One stretch of a pass: items of equal kind, done in pieces that fit a quantum.
struct Task {
  using Begin = std::function<Result<uint32_t>(const TechniqueContext&)>;
  using Work = std::function<Result<void>(const TechniqueContext&, uint32_t first, uint32_t count)>;

  const char* name = "";
  WorkRate* rate = nullptr;  ///< measured by it; null: the work is in `begin` alone
  Begin begin;               ///< says how many items there are; runs once, just before them
  Work work;                 ///< items [first, first + count)
  uint32_t leastItems = 1;   ///< of a piece
};

/// The tasks of a pass, done in order and interrupted anywhere between pieces. What they compute does not depend on where
/// the pieces end. Render thread.
class TaskQueue {
 public:
  void clear() {
    m_tasks.clear();
    m_begun = false;
  }
  void push(Task task) { m_tasks.push_back(std::move(task)); }
  bool empty() const { return m_tasks.empty(); }
  const char* current() const { return m_tasks.empty() ? "" : m_tasks.front().name; }
  size_t left() const { return m_tasks.size(); }

  /// Time spent on tasks of each name since forgetTimes(), in the order in which they first ran.
  const std::vector<StageTime>& times() const { return m_times; }
  void forgetTimes() { m_times.clear(); }

  /// Works for about `seconds`, less when the queue ends or a task does.
  Result<void> advance(const TechniqueContext& context, double seconds) {
    if (m_tasks.empty()) return {};
    const double start = nowSeconds();
    float& spent = timeOf(current());
    auto done = workOnFirst(context, seconds, start);
    spent += float((nowSeconds() - start) * 1e3);
    return done;
  }

 private:
  float& timeOf(const char* name) {
    for (StageTime& time : m_times)
      if (time.name == name) return time.ms;
    return m_times.emplace_back(StageTime{name, 0.0f}).ms;
  }

  Result<void> workOnFirst(const TechniqueContext& context, double seconds, double start) {
    Task& task = m_tasks.front();
    if (!m_begun) {
      auto items = task.begin(context);
      if (!items) return items.error();
      m_items = *items;
      m_cursor = 0;
      m_begun = true;
    }
    const double left = seconds - (nowSeconds() - start);
    if (m_cursor < m_items && left > 0.0)
      if (auto done = piece(context, task, left); !done) return done;
    if (m_cursor < m_items) return {};
    m_tasks.pop_front();
    m_begun = false;
    return {};
  }

  Result<void> piece(const TechniqueContext& context, Task& task, double seconds) {
    const uint64_t fits = std::max<uint64_t>(task.rate->itemsIn(seconds), task.leastItems);
    const uint32_t count = uint32_t(std::min<uint64_t>(fits, m_items - m_cursor));
    const double start = nowSeconds();
    if (auto done = task.work(context, m_cursor, count); !done) return done;
    task.rate->measured(count, nowSeconds() - start);
    m_cursor += count;
    return {};
  }

  std::deque<Task> m_tasks;
  std::vector<StageTime> m_times;
  bool m_begun = false;
  uint32_t m_items = 0, m_cursor = 0;
};

}  // namespace limn
