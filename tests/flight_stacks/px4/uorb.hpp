// SPDX-License-Identifier: MIT
// A small uORB of our own, with the semantics that a module of PX4 meets: a topic exists for a reader only while
// somebody advertises it when the reader first looks; a queue overwrites what was not read; a publication that is
// destroyed takes its advertisement with it, unless its topic has a queue; a reader counts generations and may be told
// what it has lost.
#pragma once

#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace uORB {

struct Node {
  std::vector<std::vector<unsigned char>> queue;
  unsigned generation = 0;
  int advertisers = 0;
  std::vector<std::function<void()>> callbacks;

  void write(const void* message, std::size_t bytes) {
    const auto* first = static_cast<const unsigned char*>(message);
    queue[generation++ % queue.size()].assign(first, first + bytes);
    for (const auto& callback : callbacks) callback();
  }
};

/// By name.
inline std::map<std::string, Node>& nodes() {
  static std::map<std::string, Node> all;
  return all;
}

/// Nobody has published anything, and nobody listens; who advertises still does.
inline void forget_messages() {
  for (auto& [name, node] : nodes()) {
    node.generation = 0;
    node.callbacks.clear();
  }
}

template <class Message, class = void>
struct QueueLength {
  static constexpr unsigned value = 1;
};
template <class Message>
struct QueueLength<Message, std::void_t<decltype(Message::ORB_QUEUE_LENGTH)>> {
  static constexpr unsigned value = Message::ORB_QUEUE_LENGTH;
};

template <class Message>
class Publication {
 public:
  explicit Publication(const char* topic) : topic_(topic) {}
  Publication(const Publication&) = delete;
  ~Publication() {
    if (advertised_ && QueueLength<Message>::value == 1) --nodes()[topic_].advertisers;
  }
  bool publish(const Message& message) {
    Node& node = nodes()[topic_];
    if (!advertised_) {
      ++node.advertisers;
      advertised_ = true;
      if (node.queue.empty()) node.queue.resize(QueueLength<Message>::value);
    }
    node.write(&message, sizeof message);
    return true;
  }

 private:
  const char* topic_;
  bool advertised_ = false;
};

class Subscription {
 public:
  explicit Subscription(const char* topic) : topic_(topic) {}
  Subscription(const Subscription&) = delete;

  bool updated() { return attach() && nodes()[topic_].generation != generation_; }
  /// The next message, or false. Overwritten messages are skipped: see lost().
  template <class Message>
  bool update(Message* message) {
    if (!updated()) return false;
    Node& node = nodes()[topic_];
    const auto length = static_cast<unsigned>(node.queue.size());
    if (node.generation - generation_ > length) {
      lost_ += node.generation - generation_ - length;
      generation_ = node.generation - length;
    }
    std::memcpy(static_cast<void*>(message), node.queue[generation_++ % length].data(), sizeof(Message));
    return true;
  }
  template <class Message>
  bool copy(Message* message) {
    if (update(message)) return true;
    if (!attach() || nodes()[topic_].generation == 0) return false;
    Node& node = nodes()[topic_];
    std::memcpy(static_cast<void*>(message), node.queue[(node.generation - 1) % node.queue.size()].data(),
                sizeof(Message));
    return true;
  }
  unsigned lost() const { return lost_; }

 private:
  /// The first look sees the last message, if somebody advertises the topic at that moment.
  bool attach() {
    if (attached_) return true;
    Node& node = nodes()[topic_];
    if (node.advertisers <= 0) return false;
    generation_ = node.generation > 0 ? node.generation - 1 : 0;
    return attached_ = true;
  }

  const char* topic_;
  unsigned generation_ = 0, lost_ = 0;
  bool attached_ = false;
};

/// A work item's subscription: its Run() is called after each message.
class SubscriptionCallbackWorkItem : public Subscription {
 public:
  template <class WorkItem>
  SubscriptionCallbackWorkItem(WorkItem* item, const char* topic)
      : Subscription(topic), topic_(topic), wake_([item] { item->ScheduleNow(); }) {}
  ~SubscriptionCallbackWorkItem() { unregisterCallback(); }
  bool registerCallback() {
    if (place_ < 0) {
      place_ = static_cast<int>(nodes()[topic_].callbacks.size());
      nodes()[topic_].callbacks.push_back(wake_);
    }
    return true;
  }
  void unregisterCallback() {
    if (place_ >= 0 && nodes().count(topic_) != 0) {
      nodes()[topic_].callbacks[static_cast<std::size_t>(place_)] = [] {};
    }
    place_ = -1;
  }

 private:
  const char* topic_;
  std::function<void()> wake_;
  int place_ = -1;
};

}  // namespace uORB

#define ORB_ID(topic) #topic
