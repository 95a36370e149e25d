// A borrowed callable; like std::function, without the heap.
#pragma once

#include <type_traits>
#include <utility>

namespace dicot {

template <typename Signature>
class FunctionRef;

/// The callable must outlive every call.
template <typename Result, typename... Words>
class FunctionRef<Result(Words...)>
{
public:
    // clang-format off
    template <typename F>
        requires(!std::is_same_v<std::remove_cvref_t<F>, FunctionRef>)
    FunctionRef(F&& f) noexcept // NOLINT(google-explicit-constructor,bugprone-forwarding-reference-overload)
        : object_(const_cast<void*>(static_cast<const void*>(&f))),
          call_([](void* object, Words... words) -> Result {
              return (*static_cast<std::remove_reference_t<F>*>(object))(std::forward<Words>(words)...);
          })
    {
    }
    // clang-format on
    Result operator()(Words... words) const { return call_(object_, std::forward<Words>(words)...); }

private:
    void* object_;
    Result (*call_)(void*, Words...);
};

} // namespace dicot
