% The loop of closed_loop.py as one writes it in Octave or MATLAB: quadrotor, extended Kalman filter, state feedback.
% Reads a file with noise, gain and set point; prints seconds and the last true state. Called by closed_loop.py.
1;

function [b1, b2, b3, b4, om] = rotors(u)
  kb = 54.2e-6; kd = 1.1e-6; s = u .^ 2;
  b1 = kb * (s(1) + s(2) + s(3) + s(4));
  b2 = kb * (-s(1) - s(2) + s(3) + s(4));
  b3 = kb * (-s(1) + s(2) + s(3) - s(4));
  b4 = kd * (s(1) - s(2) + s(3) - s(4));
  om = u(1) - u(2) + u(3) - u(4);
end

function x = moved(x, u)
  ix = 8.1e-3; iy = 8.1e-3; iz = 14.2e-3; jr = 104e-6; l = 0.24; m = 1.0;
  [b1, b2, b3, b4, om] = rotors(u);
  s7 = sin(x(7)); c7 = cos(x(7)); s9 = sin(x(9)); c9 = cos(x(9)); s11 = sin(x(11)); c11 = cos(x(11));
  rate = [x(2); (s11 * s7 + c11 * s9) * c7 * b1 / m; x(4); (-c11 * s7 + s11 * s9) * c7 * b1 / m; ...
          x(6); -9.81 + c9 * c7 * b1 / m; x(8); x(10) * x(12) * (iy - iz) / ix - jr / ix * x(10) * om + l * b2 / ix; ...
          x(10); x(8) * x(12) * (iz - ix) / iy + jr / iy * x(8) * om + l * b3 / iy; ...
          x(12); x(8) * x(10) * (ix - iy) / iz + b4 / iz];
  x = x + rate / 40;
end

function J = jacobian(x, u)
  ix = 8.1e-3; iy = 8.1e-3; iz = 14.2e-3; jr = 104e-6; m = 1.0;
  [b1, b2, b3, b4, om] = rotors(u);
  a = b1 / m;
  s7 = sin(x(7)); c7 = cos(x(7)); s9 = sin(x(9)); c9 = cos(x(9)); s11 = sin(x(11)); c11 = cos(x(11));
  X = s11 * s7 + c11 * s9; Y = -c11 * s7 + s11 * s9;
  D = zeros(12);
  for i = 1:2:11
    D(i, i + 1) = 1;
  end
  D(2, 7) = (s11 * c7 ^ 2 - X * s7) * a; D(2, 9) = c11 * c9 * c7 * a; D(2, 11) = -Y * c7 * a;
  D(4, 7) = (-c11 * c7 ^ 2 - Y * s7) * a; D(4, 9) = s11 * c9 * c7 * a; D(4, 11) = X * c7 * a;
  D(6, 7) = -c9 * s7 * a; D(6, 9) = -s9 * c7 * a;
  D(8, 10) = x(12) * (iy - iz) / ix - jr / ix * om; D(8, 12) = x(10) * (iy - iz) / ix;
  D(10, 8) = x(12) * (iz - ix) / iy + jr / iy * om; D(10, 12) = x(8) * (iz - ix) / iy;
  D(12, 8) = x(10) * (ix - iy) / iz; D(12, 10) = x(8) * (ix - iy) / iz;
  J = eye(12) + D / 40;
end

function x = flown(given)
  x = given.x_o(:); estimate = x; u = given.u_o(:); P = 0.01 / 3 * eye(12); Q = 1e-6 * eye(12); R = 0.01 * eye(12);
  for k = 1:rows(given.w)
    x = moved(x, u) + given.w(k, :)';
    z = x + given.v(k, :)';
    J = jacobian(estimate, u);
    prior = moved(estimate, u);
    P = J * P * J' + Q;
    G = P / (P + R);
    estimate = prior + G * (z - prior);
    P = (eye(12) - G) * P;
    P = (P + P') / 2;
    u = given.u_o(:) - given.K * (estimate - given.x_o(:));
  end
end

given = load(argv(){1});
seconds = Inf;
for repeat = 1:3
  started = tic;
  x = flown(given);
  seconds = min(seconds, toc(started));
end
printf('%.17g ', seconds, x);
printf('\n');
