// Coverage-guided fuzzing of native code under sanitizers, with what every GCC has: `make fuzz` builds and runs it.
//
//     PROGRAM RUNS [FOLDER]
//
// The program mutates inputs of a corpus and calls fuzz_one with each, RUNS times. The code under test is compiled with
// -fsanitize-coverage=trace-pc; an input that reaches a place, or a number of visits of one, that none reached before
// joins the corpus and, where FOLDER is given, is kept there for the next time. An input on which a sanitizer, an
// uncaught exception or 20 seconds of the processor end the program is left in FOLDER as `finding`. At the end the
// program prints the number of executions, their time, and the corpus' size.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

/// The code under test; whatever is wrong ends the program.
void fuzz_one(std::span<const uint8_t> data);

/// An input to begin with.
std::vector<uint8_t> fuzz_seed();

/// Ends the program with a message, where something that must hold does not.
[[noreturn]] void fuzz_fail(const char* what);

/// Reads values from an input; zeros after its end.
class FuzzBytes {
public:
    explicit FuzzBytes(std::span<const uint8_t> data) : data_(data) {}
    template <class T> T take() {
        T value{};
        const size_t size = data_.size() < sizeof(T) ? data_.size() : sizeof(T);
        std::memcpy(&value, data_.data(), size);
        data_ = data_.subspan(size);
        return value;
    }
    /// 0 … most.
    unsigned upto(unsigned most) { return take<uint8_t>() % (most + 1); }
    bool empty() const { return data_.empty(); }

private:
    std::span<const uint8_t> data_;
};
