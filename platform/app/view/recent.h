// The answers that were given last.
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <string>
#include <utility>

namespace dicot::app {

/// Keeps the newest `limit` of what is put into it.
template <typename Value>
class Recent
{
public:
    explicit Recent(std::size_t limit) : limit_(limit) {}

    /// Null: not there, or no longer.
    const Value* find(const std::string& key) const
    {
        const auto at = std::ranges::find(all_, key, &std::pair<std::string, Value>::first);
        return at == all_.end() ? nullptr : &at->second;
    }
    void put(const std::string& key, Value value)
    {
        if (all_.size() == limit_)
            all_.pop_front();
        all_.emplace_back(key, std::move(value));
    }
    void clear() { all_.clear(); }

private:
    std::size_t limit_;
    std::deque<std::pair<std::string, Value>> all_;
};

} // namespace dicot::app
