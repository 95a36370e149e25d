// How algorithms use several cores without knowing threads.
#pragma once

#include <type_traits>

namespace dicot {

/// A borrowed callable `void(int)`; like std::function, without the heap.
class TaskRef
{
public:
    // clang-format off
    template <typename F>
        requires(!std::is_same_v<std::remove_cvref_t<F>, TaskRef>)
    TaskRef(F&& f) noexcept // NOLINT(google-explicit-constructor,bugprone-forwarding-reference-overload)
        : object_(const_cast<void*>(static_cast<const void*>(&f))),
          call_([](void* object, int index) { (*static_cast<std::remove_reference_t<F>*>(object))(index); })
    {
    }
    // clang-format on
    void operator()(int index) const { call_(object_, index); }

private:
    void* object_;
    void (*call_)(void*, int);
};

/// Runs task(0) .. task(count - 1), each exactly once, in any order and on any thread, and returns when all are done.
class Crew
{
public:
    virtual ~Crew() = default;
    virtual int size() const = 0; ///< how many tasks may run at the same time
    virtual void run(int count, TaskRef task) = 0;
};

/// The crew of one: tasks in order, on the caller's thread.
class Alone final : public Crew
{
public:
    int size() const override { return 1; }
    void run(int count, TaskRef task) override
    {
        for (int i = 0; i < count; ++i)
            task(i);
    }
};

} // namespace dicot
