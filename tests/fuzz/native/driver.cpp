#include "driver.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <sys/time.h>
#include <unistd.h>

namespace {

constexpr size_t kLongest = 4096;
constexpr unsigned kSecondsPerRun = 20;   // of the processor
constexpr unsigned kDaytimePerRun = 3600; // seconds, for an input that waits for ever

uint8_t visits[1 << 16]; // by place, of the current input
uint8_t seen[1 << 16];   // the ranges of numbers of visits, of all inputs
std::vector<uint8_t> current;
volatile std::sig_atomic_t stopped = 0;
std::filesystem::path folder;

using Random = std::mt19937_64;

void keep(const std::string& name, std::span<const uint8_t> data) {
    if (folder.empty())
        return;
    std::ofstream(folder / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(data.data()), std::streamsize(data.size()));
}

void keep_finding() { keep("finding", current); }

/// The sanitizers end the program by SIGABRT.
void aborted(int) {
    keep_finding();
    _exit(1);
}

void too_slow(int) {
    std::fprintf(stderr, "an input takes more than %u seconds\n", kSecondsPerRun);
    keep_finding();
    _exit(1);
}

/// Whether the current input visited something for the first time, in ranges of numbers of visits: 1, 2, 3, 4-7, …
bool is_new() {
    bool found = false;
    for (size_t eight = 0; eight < std::size(visits); eight += 8) {
        uint64_t any;
        std::memcpy(&any, &visits[eight], sizeof any);
        if (any == 0) // as nearly all are
            continue;
        for (size_t i = eight; i < eight + 8; ++i) {
            if (visits[i] == 0)
                continue;
            const uint8_t n = visits[i];
            const auto range = uint8_t(n > 127 ? 128 : n > 31 ? 64 : n > 15 ? 32 : n > 7 ? 16 : n > 3 ? 8 : n);
            found = found || (seen[i] & range) != range;
            seen[i] |= range;
        }
    }
    return found;
}

void stop(int) { stopped = 1; }

double seconds_of_processor() { return double(std::clock()) / CLOCKS_PER_SEC; }

struct Input {
    std::vector<uint8_t> bytes;
    double seconds; // of the processor
};

/// The fastest of a few: otherwise slow inputs, which visit more, would soon be most of the corpus.
const std::vector<uint8_t>& choose(const std::vector<Input>& corpus, std::mt19937_64& random) {
    const Input* chosen = &corpus[random() % corpus.size()];
    for (int i = 0; i < 3; ++i) {
        const Input& other = corpus[random() % corpus.size()];
        if (other.seconds < chosen->seconds)
            chosen = &other;
    }
    return chosen->bytes;
}

/// A busy machine must not make a finding of an input: what counts is the time of the processor.
void limit_time(unsigned processor, unsigned daytime) {
    const itimerval limit{{0, 0}, {time_t(processor), 0}};
    setitimer(ITIMER_PROF, &limit, nullptr);
    alarm(daytime);
}

/// The seconds of the processor that the input takes.
double run(std::span<const uint8_t> data) {
    current.assign(data.begin(), data.end());
    std::memset(visits, 0, sizeof visits);
    limit_time(kSecondsPerRun, kDaytimePerRun);
    const double start = seconds_of_processor();
    fuzz_one(current);
    limit_time(0, 0);
    return seconds_of_processor() - start;
}

void mutate(std::vector<uint8_t>& data, const std::vector<Input>& corpus, Random& random) {
    static constexpr double kNumbers[] = {0, 1, -1, 0.5, 4096, 1e-300, 1e300, 262144, 1.0 / 4096, -0.0};
    const auto below = [&random](size_t n) { return n == 0 ? 0 : size_t(random() % n); };
    for (size_t step = 0, steps = 1 + below(4); step < steps; ++step) {
        const size_t at = below(data.size() + 1);
        switch (below(7)) {
        case 0:
            if (at < data.size())
                data[at] ^= uint8_t(1u << below(8));
            break;
        case 1:
            if (at < data.size())
                data[at] = uint8_t(random());
            break;
        case 2: {
            const size_t count = 1 + below(16);
            for (size_t i = 0; i < count; ++i)
                data.insert(data.begin() + ptrdiff_t(at), uint8_t(random()));
            break;
        }
        case 3:
            data.erase(data.begin() + ptrdiff_t(at),
                       data.begin() + ptrdiff_t(std::min(data.size(), at + 1 + below(32))));
            break;
        case 4: {
            const auto& other = choose(corpus, random);
            const size_t from = below(other.size()), count = below(other.size() - from + 1);
            data.insert(data.begin() + ptrdiff_t(at), other.begin() + ptrdiff_t(from),
                        other.begin() + ptrdiff_t(from + count));
            break;
        }
        case 5:
            if (at + sizeof(double) <= data.size())
                std::memcpy(&data[at], &kNumbers[below(std::size(kNumbers))], sizeof(double));
            break;
        default:
            if (at < data.size())
                data[at] = uint8_t(data[at] + below(17) - 8);
        }
    }
    if (data.size() > kLongest)
        data.resize(kLongest);
}

} // namespace

extern "C" const char* __asan_default_options() { return "abort_on_error=1:handle_abort=0:quarantine_size_mb=16"; }
extern "C" const char* __ubsan_default_options() { return "abort_on_error=1:print_stacktrace=1"; }

/// The compiler calls it at every branch of the code under test. Half of the time would go into checks of this one.
extern "C" __attribute__((no_sanitize("address", "undefined"))) void __sanitizer_cov_trace_pc() {
    const auto place = reinterpret_cast<uintptr_t>(__builtin_return_address(0));
    uint8_t& count = visits[(place ^ place >> 16) & 0xFFFF];
    count = uint8_t(count + (count < 255));
}

void fuzz_fail(const char* what) {
    std::fprintf(stderr, "%s\n", what);
    keep_finding();
    _exit(1);
}

int main(int count, char** arguments) {
    if (count < 2) {
        std::fprintf(stderr, "usage: %s RUNS [FOLDER]\n", arguments[0]);
        return 2;
    }
    const uint64_t runs = std::strtoull(arguments[1], nullptr, 10);
    std::vector<Input> corpus = {{fuzz_seed(), 0}};
    if (count > 2) {
        folder = arguments[2];
        std::filesystem::create_directories(folder);
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            std::ifstream file(entry.path(), std::ios::binary);
            corpus.push_back({{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()}, 0});
        }
    }
    std::signal(SIGABRT, aborted);
    std::signal(SIGALRM, too_slow);
    std::signal(SIGPROF, too_slow);
    std::signal(SIGINT, stop);
    std::signal(SIGTERM, stop);
    std::set_terminate([] {
        try {
            if (const std::exception_ptr error = std::current_exception())
                std::rethrow_exception(error);
        } catch (const std::exception& error) {
            fuzz_fail(error.what());
        } catch (...) {
        }
        fuzz_fail("an exception that nobody caught");
    });
    std::random_device entropy;
    Random random((uint64_t(entropy()) << 32) | entropy());
    for (auto& input : corpus) {
        input.seconds = run(input.bytes);
        is_new();
    }
    const auto start = std::chrono::steady_clock::now();
    uint64_t done = 0;
    for (; done < runs && !stopped; ++done) {
        std::vector<uint8_t> input = choose(corpus, random);
        mutate(input, corpus, random);
        const double seconds = run(input);
        if (is_new()) {
            keep(std::to_string(corpus.size()) + "-" + std::to_string(random()), input);
            corpus.push_back({std::move(input), seconds});
        }
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::printf("%llu executions in %.0f s, a corpus of %zu inputs, no finding\n",
                static_cast<unsigned long long>(done), seconds.count(), corpus.size());
    return 0;
}
