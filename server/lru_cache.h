// A map that forgets what was used longest ago once its values outgrow a
// budget of bytes.
#ifndef MARROW_SERVER_LRU_CACHE_H_
#define MARROW_SERVER_LRU_CACHE_H_

#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <utility>

namespace marrow {

// Invariants: `entries_` and `order_` hold the same keys; `bytes_` is the sum
// of the entries' bytes and at most `budget_`.
//
// Values are shared: an entry that is dropped lives on with whoever holds it.
// Not thread safe.
template <typename Key, typename Value>
class LruCache {
 public:
  explicit LruCache(uint64_t budget) : budget_(budget) {}

  // Null where there is none; otherwise the entry is the youngest now.
  std::shared_ptr<const Value> Find(const Key& key) {
    auto it = entries_.find(key);
    if (it == entries_.end()) return nullptr;
    order_.splice(order_.begin(), order_, it->second.place);
    return it->second.value;
  }

  // As Find(), but they leave the order alone.
  bool Contains(const Key& key) const { return entries_.contains(key); }
  std::shared_ptr<const Value> Peek(const Key& key) const {
    auto it = entries_.find(key);
    return it == entries_.end() ? nullptr : it->second.value;
  }

  // Replaces an entry of the same key. A value above the whole budget is not
  // kept, and drops nothing.
  void Insert(const Key& key, std::shared_ptr<const Value> value,
              uint64_t bytes) {
    if (bytes > budget_) return;
    Erase(key);
    while (bytes_ + bytes > budget_) Erase(Key(order_.back()));
    order_.push_front(key);
    entries_.emplace(key, Entry{std::move(value), bytes, order_.begin()});
    bytes_ += bytes;
  }

  uint64_t bytes() const { return bytes_; }

 private:
  struct Entry {
    std::shared_ptr<const Value> value;
    uint64_t bytes;
    typename std::list<Key>::iterator place;
  };

  void Erase(const Key& key) {
    auto it = entries_.find(key);
    if (it == entries_.end()) return;
    bytes_ -= it->second.bytes;
    order_.erase(it->second.place);
    entries_.erase(it);
  }

  const uint64_t budget_;
  uint64_t bytes_ = 0;
  std::list<Key> order_;  // the youngest first
  std::map<Key, Entry> entries_;
};

}  // namespace marrow

#endif  // MARROW_SERVER_LRU_CACHE_H_
