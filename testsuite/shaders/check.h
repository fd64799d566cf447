// SPDX-License-Identifier: Apache-2.0
// For SL cases: CHECK("what", got, wanted, tolerance) prints a line that begins with "wrong" when
// they differ, or when got is not a number. A case expects that no such line came and that its
// surface became white.
#define CHECK(what, got, want, tolerance)                                                          \
    {                                                                                              \
        float got_ = got;                                                                          \
        float want_ = want;                                                                        \
        if (!(abs(got_ - want_) <= tolerance)) {                                                   \
            printf("wrong %s: %f, expected %f\n", what, got_, want_);                              \
            wrong += 1;                                                                            \
        }                                                                                          \
    }
#define CHECK3(what, got, want, tolerance)                                                         \
    {                                                                                              \
        vector got_ = got;                                                                         \
        vector want_ = want;                                                                       \
        if (!(length(got_ - want_) <= tolerance)) {                                                \
            printf("wrong %s: %p, expected %p\n", what, got_, want_);                              \
            wrong += 1;                                                                            \
        }                                                                                          \
    }
#define CHECK_COLOR(what, got, want, tolerance)                                                    \
    {                                                                                              \
        color got_ = got;                                                                          \
        color want_ = want;                                                                        \
        color off_ = got_ - want_;                                                                 \
        if (!(abs(comp(off_, 0)) + abs(comp(off_, 1)) + abs(comp(off_, 2)) <= tolerance)) {        \
            printf("wrong %s: %c, expected %c\n", what, got_, want_);                              \
            wrong += 1;                                                                            \
        }                                                                                          \
    }
#define BEGIN_CHECKS float wrong = 0;
#define END_CHECKS                                                                                 \
    Oi = 1;                                                                                        \
    Ci = wrong == 0 ? color(1, 1, 1) : color(1, 0, 0);
