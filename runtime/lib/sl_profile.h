/* SPDX-License-Identifier: Apache-2.0
 * Stamps of objects compiled for profiles (docs/shader_profile.md): at each place of the source the
 * time since the place before is added to that one's row. Rows belong to the thread, the cursor to
 * one execution on one packet: nested executions do not meet. */
#ifndef PERIGEE_SL_PROFILE_H
#define PERIGEE_SL_PROFILE_H

typedef struct sl_profile_cursor {
    sl_profile_row* rows; /* NULL: nobody counts */
    uint64_t since;
    uint32_t row;
} sl_profile_cursor;

/* Statements stay on their side of it, as far as the compiler sees memory and volatile code. */
SL_INLINE uint64_t sl_profile_ticks(void) {
    __asm__ volatile("" ::: "memory");
#if defined(__x86_64__)
    const uint64_t now = __builtin_ia32_rdtsc();
#elif defined(__aarch64__)
    uint64_t now;
    __asm__ volatile("mrs %0, cntvct_el0" : "=r"(now));
#else
    const uint64_t now = 0; /* counts only */
#endif
    __asm__ volatile("" ::: "memory");
    return now;
}

SL_INLINE void sl_profile_at(sl_profile_cursor* cursor, uint32_t row, sli mask) {
    if (!cursor->rows)
        return;
    const uint64_t now = sl_profile_ticks();
    cursor->rows[cursor->row].ticks += now - cursor->since;
    cursor->since = now;
    cursor->row = row;
    cursor->rows[row].packets += 1;
    cursor->rows[row].lanes += (uint32_t)__builtin_popcount(sl_bits(mask));
}

SL_INLINE void sl_profile_begin(sl_profile_cursor* cursor, const sl_call* call) {
    cursor->rows = call->services->profile ? call->services->profile(call->engine) : 0;
    cursor->row = 0;
    cursor->since = sl_profile_ticks();
    sl_profile_at(cursor, 0, call->live);
}

#endif
