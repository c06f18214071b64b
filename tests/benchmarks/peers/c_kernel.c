// Forces of triangles in vectors, one after the other into slots; then each vertex sums its slots.
// WIDTH triangles are computed together (1, 4, 8 or 16); 0 for AVX-512 by hand, where the processor has it.
#include <math.h>
#include <stdint.h>
#if WIDTH == 0
#include <immintrin.h>
#endif
#ifdef _OPENMP
#include <omp.h>
#endif
typedef struct { float x, y; } pair;

static inline void one(const pair *u, int i, int j, int k, float b0, float b1, float b2, float b3, float s, float l, pair *f) {
    float ax = u[j].x - u[i].x, ay = u[j].y - u[i].y, bx = u[k].x - u[i].x, by = u[k].y - u[i].y;
    float g00 = ax * b0 + bx * b2, g01 = ax * b1 + bx * b3, g10 = ay * b0 + by * b2, g11 = ay * b1 + by * b3;
    float c = 2.0f + g00 + g11 + 1e-15f, n = g10 - g01;
    float r = 1.0f / sqrtf(c * c + n * n);
    c *= r; n *= r;
    float p = l * (g00 + g11 + g00 * g11 - g01 * g10);
    float p00 = s * (1.0f + g00 - c) + p * (1.0f + g11), p01 = s * (g01 + n) - p * g10;
    float p10 = s * (g10 - n) - p * g01, p11 = s * (1.0f + g11 - c) + p * (1.0f + g00);
    f[0].x = p00 * b0 + p01 * b1; f[0].y = p10 * b0 + p11 * b1;
    f[1].x = p00 * b2 + p01 * b3; f[1].y = p10 * b2 + p11 * b3;
}
#if WIDTH == 0
static inline void load_corner(const pair *u, const int32_t *t, __m512 *x, __m512 *y) {
    __m512i v = _mm512_loadu_si512(t);
    __m512 lo = _mm512_castpd_ps(_mm512_i32gather_pd(_mm512_castsi512_si256(v), (const double *)u, 8));
    __m512 hi = _mm512_castpd_ps(_mm512_i32gather_pd(_mm512_extracti64x4_epi64(v, 1), (const double *)u, 8));
    const __m512i even = _mm512_setr_epi32(0,2,4,6,8,10,12,14,16,18,20,22,24,26,28,30);
    const __m512i odd = _mm512_setr_epi32(1,3,5,7,9,11,13,15,17,19,21,23,25,27,29,31);
    *x = _mm512_permutex2var_ps(lo, even, hi);
    *y = _mm512_permutex2var_ps(lo, odd, hi);
}
static inline void store_pairs(pair *f, __m512 x, __m512 y) {
    const __m512i low = _mm512_setr_epi32(0,16,1,17,2,18,3,19,4,20,5,21,6,22,7,23);
    const __m512i high = _mm512_setr_epi32(8,24,9,25,10,26,11,27,12,28,13,29,14,30,15,31);
    _mm512_storeu_ps((float *)f, _mm512_permutex2var_ps(x, low, y));
    _mm512_storeu_ps((float *)(f + 8), _mm512_permutex2var_ps(x, high, y));
}
#define V(x) _mm512_set1_ps(x)
#define ADD _mm512_add_ps
#define SUB _mm512_sub_ps
#define MUL _mm512_mul_ps
#define FMA _mm512_fmadd_ps
#define FNMA _mm512_fnmadd_ps
#endif
// n is a multiple of 16 (padded with b = 0); arrays of n entries one after the other: corners[3], b[4], s, l
static void forces(int first, int end, int n, const int32_t *corner, const float *b, const pair *u, pair *f) {
#if WIDTH == 0
    for (int t = first; t < end; t += 16) {
        __m512 x0, y0, x1, y1, x2, y2;
        load_corner(u, corner + t, &x0, &y0);
        load_corner(u, corner + n + t, &x1, &y1);
        load_corner(u, corner + 2 * n + t, &x2, &y2);
        __m512 b0 = _mm512_loadu_ps(b + t), b1 = _mm512_loadu_ps(b + n + t), b2 = _mm512_loadu_ps(b + 2 * n + t), b3 = _mm512_loadu_ps(b + 3 * n + t);
        __m512 s = _mm512_loadu_ps(b + 4 * n + t), l = _mm512_loadu_ps(b + 5 * n + t);
        __m512 ax = SUB(x1, x0), ay = SUB(y1, y0), bx = SUB(x2, x0), by = SUB(y2, y0);
        __m512 g00 = FMA(ax, b0, MUL(bx, b2)), g01 = FMA(ax, b1, MUL(bx, b3)), g10 = FMA(ay, b0, MUL(by, b2)), g11 = FMA(ay, b1, MUL(by, b3));
        __m512 trace = ADD(g00, g11), c = ADD(V(2.0f), trace), z = SUB(g10, g01), q = FMA(c, c, MUL(z, z));
        __m512 r = _mm512_rsqrt14_ps(q);
        r = MUL(r, FNMA(MUL(MUL(q, V(0.5f)), r), r, V(1.5f)));
        c = MUL(c, r); z = MUL(z, r);
        __m512 p = MUL(l, ADD(trace, FNMA(g01, g10, MUL(g00, g11))));
        __m512 e00 = ADD(V(1.0f), g00), e11 = ADD(V(1.0f), g11);
        __m512 p00 = FMA(s, SUB(e00, c), MUL(p, e11)), p01 = FNMA(p, g10, MUL(s, ADD(g01, z)));
        __m512 p10 = FNMA(p, g01, MUL(s, SUB(g10, z))), p11 = FMA(s, SUB(e11, c), MUL(p, e00));
        __m512 f1x = FMA(p00, b0, MUL(p01, b1)), f1y = FMA(p10, b0, MUL(p11, b1)), f2x = FMA(p00, b2, MUL(p01, b3)), f2y = FMA(p10, b2, MUL(p11, b3));
        store_pairs(f + t, SUB(_mm512_setzero_ps(), ADD(f1x, f2x)), SUB(_mm512_setzero_ps(), ADD(f1y, f2y)));
        store_pairs(f + n + t, f1x, f1y);
        store_pairs(f + 2 * n + t, f2x, f2y);
    }
#else
    for (int t = first; t < end; t += WIDTH) {
        float x[3][WIDTH], y[3][WIDTH], p[3][WIDTH], q[3][WIDTH];
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < WIDTH; k++) { pair at = u[corner[c * n + t + k]]; x[c][k] = at.x; y[c][k] = at.y; }
        for (int k = 0; k < WIDTH; k++) {
            pair three[3] = {{x[0][k], y[0][k]}, {x[1][k], y[1][k]}, {x[2][k], y[2][k]}}, h[2];
            const float *d = b + t + k;
            one(three, 0, 1, 2, d[0], d[n], d[2 * n], d[3 * n], d[4 * n], d[5 * n], h);
            p[0][k] = -h[0].x - h[1].x; q[0][k] = -h[0].y - h[1].y;
            p[1][k] = h[0].x; q[1][k] = h[0].y; p[2][k] = h[1].x; q[2][k] = h[1].y;
        }
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < WIDTH; k++) { f[c * n + t + k].x = p[c][k]; f[c * n + t + k].y = q[c][k]; }
    }
#endif
}
static void integrate(int first, int end, const int32_t *start, const int32_t *slot, const float *inverse_mass, float dt, float decay, pair *u, pair *v, const pair *f) {
    for (int i = first; i < end; i++) {
        float x = 0, y = 0;
        for (int e = start[i]; e < start[i + 1]; e++) { x += f[slot[e]].x; y += f[slot[e]].y; }
        v[i].x = decay * (v[i].x - dt * inverse_mass[i] * x);
        v[i].y = decay * (v[i].y - dt * inverse_mass[i] * y);
        u[i].x += dt * v[i].x; u[i].y += dt * v[i].y;
    }
}
void advance(int steps, int n, int vertices, const int32_t *corner, const float *b, const int32_t *start, const int32_t *slot, const float *inverse_mass, float dt, float decay, pair *u, pair *v, pair *f) {
#ifdef _OPENMP
#pragma omp parallel
    {
        int me = omp_get_thread_num(), all = omp_get_num_threads();
        int t0 = (int)((int64_t)(n / 16) * me / all) * 16, t1 = (int)((int64_t)(n / 16) * (me + 1) / all) * 16;
        int i0 = (int)((int64_t)vertices * me / all), i1 = (int)((int64_t)vertices * (me + 1) / all);
        for (int s = 0; s < steps; s++) {
            forces(t0, t1, n, corner, b, u, f);
#pragma omp barrier
            integrate(i0, i1, start, slot, inverse_mass, dt, decay, u, v, f);
#pragma omp barrier
        }
    }
#else
    for (int s = 0; s < steps; s++) {
        forces(0, n, n, corner, b, u, f);
        integrate(0, vertices, start, slot, inverse_mass, dt, decay, u, v, f);
    }
#endif
}
