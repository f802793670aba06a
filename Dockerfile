# The service as an image of its own files and the libraries that they need, nothing else: no shell, no package
# manager. Licences and the bill of materials are in /usr/share/doc/fleetplan. Builds with BuildKit and without it.
#
#   docker build -t fleetplan .
#   docker build -t fleetplan --build-arg DEBIAN_SUITE=bookworm .
ARG DEBIAN_SUITE=trixie

FROM debian:${DEBIAN_SUITE}-slim AS build
WORKDIR /src
COPY scripts/lib.sh scripts/
RUN bash -euo pipefail -c '. scripts/lib.sh; need_packages "${BUILD_PACKAGES[@]}" "${UNIT_TEST_PACKAGES[@]}"'
COPY . .
RUN scripts/test --quick
RUN deploy/image/make-root build/release /image

FROM scratch
ARG DEBIAN_SUITE
ARG CREATED
ARG REVISION
LABEL org.opencontainers.image.title="Fleetplan" \
      org.opencontainers.image.description="Plans collision-free, timed motions for fleets of robots, over HTTP" \
      org.opencontainers.image.licenses="Apache-2.0" \
      org.opencontainers.image.version="0.1.0" \
      org.opencontainers.image.revision="${REVISION}" \
      org.opencontainers.image.created="${CREATED}" \
      org.opencontainers.image.base.name="debian:${DEBIAN_SUITE}-slim"
COPY --from=build /image /
# The ports of requests and of health and metrics; an empty FLEETPLAN_ADMIN_PORT turns the second one off. Engines
# kill a container that does not end within 10 s.
ENV FLEETPLAN_HOST=0.0.0.0 FLEETPLAN_PORT=8080 FLEETPLAN_ADMIN_PORT=8081 FLEETPLAN_DRAIN_MS=8000
EXPOSE 8080 8081
USER 65532:65532
HEALTHCHECK --interval=10s --timeout=10s --start-period=5s --retries=3 CMD ["/usr/local/bin/fleetplan", "--healthcheck"]
ENTRYPOINT ["/usr/local/bin/fleetplan"]
