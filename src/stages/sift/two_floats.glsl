// Numbers of about 47 bits as the unevaluated sum x + y of two floats, for devices without doubles: enough to round to the same
// float as a double does, but for one case in thousands. Sums and products of floats are correctly rounded in Vulkan, quotients
// and square roots are not; `precise` keeps compilers from contracting or reordering.
// Dekker, "A floating-point technique for extending the available precision", 1971; Knuth, TAOCP 2, 4.2.2.

// a + b; |a| >= |b|
vec2 sum_of_ordered(float a, float b) {
  precise float sum = a + b;
  precise float rest = b - (sum - a);
  return vec2(sum, rest);
}

vec2 sum_of(float a, float b) {
  precise float sum = a + b;
  precise float b_part = sum - a;
  precise float rest = (a - (sum - b_part)) + (b - b_part);
  return vec2(sum, rest);
}

// Upper and lower half of a float's bits.
vec2 halves_of(float a) {
  precise float shifted = 4097.0 * a;
  precise float high = shifted - (shifted - a);
  precise float low = a - high;
  return vec2(high, low);
}

vec2 product_of(float a, float b) {
  precise float product = a * b;
  const vec2 c = halves_of(a), d = halves_of(b);
  precise float rest = ((c.x * d.x - product) + c.x * d.y + c.y * d.x) + c.y * d.y;
  return vec2(product, rest);
}

vec2 add(vec2 a, vec2 b) {
  const vec2 high = sum_of(a.x, b.x), low = sum_of(a.y, b.y);
  precise float rest = high.y + low.x;
  const vec2 sum = sum_of_ordered(high.x, rest);
  precise float last = sum.y + low.y;
  return sum_of_ordered(sum.x, last);
}

vec2 subtract(vec2 a, vec2 b) { return add(a, -b); }

vec2 multiply(vec2 a, vec2 b) {
  const vec2 high = product_of(a.x, b.x);
  precise float rest = high.y + (a.x * b.y + a.y * b.x);
  return sum_of_ordered(high.x, rest);
}

// Long division; the device's own quotients may be off by some last bits.
vec2 divide(vec2 a, vec2 b) {
  const float first = a.x / b.x;
  vec2 rest = subtract(a, multiply(b, vec2(first, 0)));
  const float second = rest.x / b.x;
  rest = subtract(rest, multiply(b, vec2(second, 0)));
  return add(sum_of(first, second), vec2(rest.x / b.x, 0));
}

// a / b as IEEE rounds it.
float quotient(float a, float b) {
  const float first = a / b;
  const vec2 product = product_of(first, b);
  precise float rest = (a - product.x) - product.y;
  precise float rounded = first + rest / b;
  return rounded;
}

// One step of Newton's from the device's own root; 0 for 0, and for what devices may flush to 0 on the way.
vec2 root_of(vec2 a) {
  if (a.x < 1e-36) return vec2(0);
  const float first = sqrt(a.x);
  const vec2 rest = subtract(a, product_of(first, first));
  return sum_of(first, rest.x / (2 * first));
}

// e^x for x in [-20, 2], as sift::exponential computes it.
vec2 exponential(vec2 x) {
  const vec2 t = x * (1.0 / 1024);
  const vec2 sixth = vec2(0.166666672, -4.96705388e-09), twentyfourth = vec2(0.0416666679, -1.24176347e-09);
  vec2 r = add(vec2(0.5, 0), multiply(t, add(sixth, multiply(t, twentyfourth))));
  r = add(vec2(1, 0), multiply(t, add(vec2(1, 0), multiply(t, r))));
  for (int i = 0; i < 10; ++i) r = multiply(r, r);
  return r;
}
